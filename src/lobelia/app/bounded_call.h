// Calls that nobody can stop, such as looking up the name of a host.
#pragma once

#include <chrono>
#include <future>
#include <memory>
#include <optional>
#include <thread>
#include <type_traits>
#include <utility>

namespace lobelia::app {

// The result of f(), or nothing when it takes longer: it then goes on in a thread of its own and
// its result is thrown away, so it must own all it uses.
template <class F>
auto calledWithin(double seconds, F f) -> std::optional<std::invoke_result_t<F>> {
  std::packaged_task<std::invoke_result_t<F>()> task(std::move(f));
  auto result = task.get_future();
  std::thread(std::move(task)).detach();
  if (result.wait_for(std::chrono::duration<double>(seconds)) != std::future_status::ready)
    return std::nullopt;
  return result.get();
}

}  // namespace lobelia::app
