// Some of many virtual lights, scaled: what a strategy that picks lights hands to gatherAll().
#pragma once

#include <span>

#include "lobelia/gather/light_range.h"

namespace lobelia::gather {

struct ChosenLight {
  LightClass lightClass = LightClass::omni;
  size_t index = 0;      // in its class
  Rgb scale = Rgb(1.f);  // of its intensity
  // Shadow rays: one from each receiver; the same, which shows whether the receivers of the tile
  // see alike; where they do, one that answers for all. Of tiles of one strip.
  enum class Rays : uint8_t { own, pilot, shared };
  Rays rays = Rays::own;
  // In the order in which lights are gathered.
  bool operator<(const ChosenLight& other) const {
    return lightClass != other.lightClass ? lightClass < other.lightClass : index < other.index;
  }
};

// The chosen lights with all that is known about their set; each keeps its class, depth and group.
// chosen: sorted by class and index, none twice.
VirtualLights chooseLights(const VirtualLights& lights, std::span<const ChosenLight> chosen);

// Numbers the lights that some receiver may gather, class after class.
class LightNumbers {
 public:
  LightNumbers(const VirtualLights& lights, const GatherSettings& settings);
  size_t count() const { return count_; }
  // Blocks of neighbours, none across classes.
  size_t blockCount() const { return blocks_; }
  struct Block {
    LightClass lightClass = LightClass::omni;
    size_t first = 0, count = 0;  // in the class
    size_t number = 0;            // of the first
  };
  Block block(size_t i) const;
  ChosenLight at(size_t number) const;

 private:
  LightRange ranges_[std::size(kLightClasses)];
  size_t count_ = 0, blocks_ = 0;
};

}  // namespace lobelia::gather
