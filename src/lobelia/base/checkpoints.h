// How a long stage lets another run of the program take its work up: it lists its state as named
// arrays, offers them for saving when it may be asked to, and fills them again when the run goes on
// from a checkpoint. The stage knows nothing of files; the application implements Checkpoints.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace lobelia {

// Views of a stage's arrays. Their sizes follow from scene and settings: loading changes none.
struct StateFields {
  struct Field {
    std::string name;
    std::span<std::byte> bytes;
  };
  std::vector<Field> fields;

  template <class T>
  void add(std::string name, std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    fields.push_back({std::move(name), std::as_writable_bytes(std::span(values))});
  }
  template <class T>
  void addValue(std::string name, T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    fields.push_back({std::move(name), std::as_writable_bytes(std::span(&value, 1))});
  }
};

class Checkpoints {
 public:
  virtual ~Checkpoints() = default;
  // Is it time to save? From any thread.
  virtual bool due() const = 0;
  // The counters of the statistics are now those of the state, whenever it will be saved: what a
  // cancelled piece of work counts goes with it.
  virtual void markCounts() = 0;
  // No other thread may be changing the state.
  virtual void save(std::string_view stage, const StateFields& state) = 0;
  // When the run goes on from a checkpoint that this stage has saved: fills the state. Throws
  // InputError when it does not fit.
  virtual bool load(std::string_view stage, const StateFields& state) = 0;
  // Sets the counters to those of the loaded state: after work that had to be done again.
  virtual void restoreCounts() = 0;
};

}  // namespace lobelia
