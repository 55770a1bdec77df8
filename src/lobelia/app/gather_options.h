// How the user chose to gather: the strategies' options, with their defaults filled in.
#pragma once

#include <string>

#include "lobelia/app/render_options.h"

namespace lobelia::app {

// Throws UsageError where options of a strategy are given to another, or a strategy to what has no
// virtual lights.
void requireGather(const RenderOptions& options);
// What a receiver's work is in proportion to, in lights gathered by brute force, at most.
size_t gatheredLights(size_t lights, const RenderOptions& options);

// Options with the strategy's defaults filled in.
std::string cutModeOf(const RenderOptions& options);
size_t cutSizeOf(const RenderOptions& options);
// Does the strategy refine pairs of nodes (--sglc-mode paper)? Does it want all receivers of a
// pixel together? Has it a --cut-size, a --threshold? Its --bound.
bool gathersPairs(const RenderOptions& options);
bool gathersPixels(const RenderOptions& options);
bool hasCutSize(const RenderOptions& options);
bool hasThreshold(const RenderOptions& options);
double thresholdOf(const RenderOptions& options);
std::string boundOf(const RenderOptions& options);
std::string boundFormOf(const RenderOptions& options);
std::string shareOf(const RenderOptions& options);
std::string childrenOf(const RenderOptions& options);
uint64_t memoryOf(const RenderOptions& options);
std::string illumcutRaysOf(const RenderOptions& options);
size_t slicesOf(const RenderOptions& options);
size_t sliceColumnsOf(const RenderOptions& options);
size_t richLightsOf(const RenderOptions& options);
std::string richRadianceOf(const RenderOptions& options);
int richTexelsOf(const RenderOptions& options);
int richLobesOf(const RenderOptions& options);

}  // namespace lobelia::app
