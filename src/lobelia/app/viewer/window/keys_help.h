// The overview of keys and of what the mouse does. docs/manual.md has the same table.
#pragma once

namespace lobelia::app {

// In the middle of the window; sets `open` to false when it is closed.
void drawKeysHelp(bool& open);

}  // namespace lobelia::app
