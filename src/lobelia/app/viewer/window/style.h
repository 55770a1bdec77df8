// How the panels look: quiet greys, so that colours of the picture are judged beside nothing gaudy.
#pragma once

namespace lobelia::app {

// scale: of text and spaces, 1 for a screen of 96 dots an inch. pixelScale: framebuffer pixels to a
// unit of Dear ImGui; letters are drawn as fine. The backend has to make its texture of the letters
// anew.
void applyStyle(float scale, float pixelScale);

}  // namespace lobelia::app
