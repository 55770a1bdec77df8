// Rows of slices and diffuse lobes as chunks of a store file.
#pragma once

#include <string>

#include "lobelia/store/store.h"
#include "lobelia/transfer/transfer_data.h"

namespace lobelia::transfer {

// `name`: of the rows; their chunks' names begin with it. Rows and passes have to stay until the
// writer has saved them: they are not copied.
void addRows(const SliceRows& rows, const std::string& name, store::Writer* writer);
// Throws InputError, which names the file, unless there are so many rows of so many columns.
SliceRows readRows(const store::Reader& reader, const std::string& file, const std::string& name,
                   size_t rows, size_t columns);
// The same of a pass: its rows are "NAMEg0", "NAMEg1"... by class, its diffuse lobes "NAMEd".
struct PassSize {
  size_t classes = 1;  // of glossy lobes
  size_t rows = 0, columns = 0;
  size_t diffuse = 0;  // sides of vertices, of all of which there are diffuse lobes or of none
};
void addPass(std::span<const SliceRows> glossy, std::span<const DiffuseLobes> diffuse,
             const std::string& name, store::Writer* writer);
TransferPass readPass(const store::Reader& reader, const std::string& file, const std::string& name,
                      const PassSize& size);
// "backs": the vertices that are diffuse behind. Throws InputError unless all are below rows, and
// ascend.
void addDiffuseSides(const DiffuseSides& sides, store::Writer* writer);
DiffuseSides readDiffuseSides(const store::Reader& reader, const std::string& file, size_t rows);

}  // namespace lobelia::transfer
