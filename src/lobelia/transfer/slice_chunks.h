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
// classes: of glossy lobes.
void addPass(std::span<const SliceRows> glossy, std::span<const DiffuseLobes> diffuse,
             const std::string& name, store::Writer* writer);
TransferPass readPass(const store::Reader& reader, const std::string& file, const std::string& name,
                      size_t classes, size_t rows, size_t columns);

}  // namespace lobelia::transfer
