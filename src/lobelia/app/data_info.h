// What `lobelia info` says of a file that `lobelia precompute` wrote.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace lobelia::app {

// None: the file is none of ours, or there is none. Throws InputError for one that is damaged, of
// another version, or that holds anything else of ours.
std::optional<nlohmann::ordered_json> describeData(const std::string& file);

}  // namespace lobelia::app
