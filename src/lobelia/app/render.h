// `lobelia render`: one page, the life of a picture.
#pragma once

#include "lobelia/app/render_options.h"
#include "lobelia/base/error.h"

namespace lobelia::app {

ExitCode render(const RenderOptions& options, const GlobalOptions& global,
                const std::string& commandLine);

}  // namespace lobelia::app
