// `lobelia relight`: light groups mixed anew. `lobelia show`: one layer of a picture as PNG.
#pragma once

#include <string>
#include <vector>

#include "lobelia/base/error.h"

namespace CLI {
class App;
}

namespace lobelia::app {

struct RelightOptions {
  std::string image;
  std::vector<std::string> groups;   // NAME=SCALE[,R,G,B]
  std::vector<std::string> outputs;  // .exr and .png
  float exposure = 0;
};
void addRelightOptions(CLI::App& command, RelightOptions& options);
ExitCode relight(const RelightOptions& options);

struct ShowOptions {
  std::string image, layer, output;
  bool falseColor = false;
  float exposure = 0;
};
void addShowOptions(CLI::App& command, ShowOptions& options);
ExitCode show(const ShowOptions& options);

}  // namespace lobelia::app
