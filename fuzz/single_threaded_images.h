// OpenImageIO in one thread: waiting for the library's own takes longer than small images do. To be
// included by one file of a target.
#pragma once

#include <OpenImageIO/imageio.h>

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  OIIO::attribute("threads", 1);
  OIIO::attribute("exr_threads", -1);
  return 0;
}
