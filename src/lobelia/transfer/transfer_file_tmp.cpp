#include "lobelia/transfer/transfer_data.h"
namespace lobelia::transfer {
size_t TransferData::recordCount() const {
  size_t n = 0;
  for (const TransferPass& pass : passes) for (const SliceRows& rows : pass.glossy) n += rows.recordCount();
  return n;
}
size_t TransferData::byteCount() const {
  size_t n = reflection.byteCount();
  for (const TransferPass& pass : passes) {
    for (const SliceRows& rows : pass.glossy) n += rows.byteCount();
    n += pass.diffuse.size() * sizeof(DiffuseLobes);
  }
  return n;
}
}
