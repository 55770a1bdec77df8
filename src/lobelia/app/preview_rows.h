// Shows rows of a film whose picture is the sum of its layers "direct" and "indirect".
#pragma once

#include "lobelia/app/render_options.h"
#include "lobelia/film/film.h"
#include "lobelia/film/film_preview.h"

namespace lobelia::app {

// The layers' values times scale, of the parts that --component names; rows [y0, y1) of the window.
void previewRows(FilmPreview& preview, const Film& film, const RenderOptions& options, int y0,
                 int y1, float scale);

}  // namespace lobelia::app
