// Shares and lobes are stored apart: each packs better alone.
#include "lobelia/transfer/slice_chunks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

namespace lobelia::transfer {
namespace {

[[noreturn]] void damaged(const std::string& file, const std::string& what) {
  throw InputError({file}, what + "; make it again with `lobelia precompute --method vmf`");
}

// recordAt(i) of `count` records.
template <class At>
void addRecords(uint64_t count, const At& recordAt, const std::string& name,
                store::Writer* writer) {
  const auto add = [&](const char* suffix, const auto& part) {
    writer->addLater<uint32_t>(name + suffix, count,
                               [recordAt, part](uint64_t first, std::span<uint32_t> out) {
                                 for (uint32_t& v : out) v = part(recordAt(first++));
                               });
  };
  add("-s", [](SliceRecord record) { return record.share; });
  add("-l", [](SliceRecord record) { return record.lobe; });
}

SliceRecords readRecords(const store::Reader& reader, const std::string& file,
                         const std::string& name) {
  const auto shares = reader.get<uint32_t>(name + "-s"), lobes = reader.get<uint32_t>(name + "-l");
  if (shares.size() != lobes.size())
    damaged(file,
            fmt::format("'{}' has {} shares for {} lobes", name, shares.size(), lobes.size()));
  SliceRecords records;
  std::array<SliceRecord, 1024> some;
  for (size_t i = 0; i < shares.size();) {
    size_t count = 0;
    for (; count < some.size() && i < shares.size(); ++i) some[count++] = {shares[i], lobes[i]};
    records.append(std::span(some).first(count));
  }
  return records;
}

}  // namespace

void addRows(const SliceRows& rows, const std::string& name, store::Writer* writer) {
  writer->addLater<uint64_t>(name + "-b", rows.bits().size(),
                             [bits = rows.bits()](uint64_t first, std::span<uint64_t> out) {
                               std::copy_n(bits.begin() + static_cast<std::ptrdiff_t>(first),
                                           out.size(), out.begin());
                             });
  addRecords(
      rows.recordCount(), [&records = rows.records()](uint64_t i) { return records[i]; }, name,
      writer);
}

SliceRows readRows(const store::Reader& reader, const std::string& file, const std::string& name,
                   size_t rows, size_t columns) {
  try {
    SliceRows out(columns, reader.get<uint64_t>(name + "-b"), readRecords(reader, file, name));
    if (out.rowCount() != rows)
      damaged(file, fmt::format("'{}' has {} rows for {} vertices", name, out.rowCount(), rows));
    return out;
  } catch (const std::invalid_argument& e) {
    damaged(file, e.what());
  }
}

void addPass(std::span<const SliceRows> glossy, std::span<const DiffuseLobes> diffuse,
             const std::string& name, store::Writer* writer) {
  for (size_t c = 0; c < glossy.size(); ++c)
    addRows(glossy[c], fmt::format("{}g{}", name, c), writer);
  addRecords(
      diffuse.size() * kOctants,
      [diffuse](uint64_t i) { return diffuse[i / kOctants][i % kOctants]; }, name + "d", writer);
}

TransferPass readPass(const store::Reader& reader, const std::string& file, const std::string& name,
                      const PassSize& size) {
  TransferPass pass;
  for (size_t c = 0; c < size.classes; ++c)
    pass.glossy.push_back(
        readRows(reader, file, fmt::format("{}g{}", name, c), size.rows, size.columns));
  const SliceRecords records = readRecords(reader, file, name + "d");
  if (records.size() > 0 && records.size() != size.diffuse * kOctants)
    damaged(file, fmt::format("'{}' has {} diffuse lobes for {} sides of vertices", name,
                              records.size(), size.diffuse));
  pass.diffuse.resize(records.size() / kOctants);
  for (size_t i = 0; i < records.size(); ++i) pass.diffuse[i / kOctants][i % kOctants] = records[i];
  return pass;
}

void addDiffuseSides(const DiffuseSides& sides, store::Writer* writer) {
  const std::vector<uint32_t> backs = sides.backs();
  writer->add("backs", std::span<const uint32_t>(backs));
}

DiffuseSides readDiffuseSides(const store::Reader& reader, const std::string& file, size_t rows) {
  try {
    return {rows, reader.get<uint32_t>("backs")};
  } catch (const std::invalid_argument& e) {
    damaged(file, e.what());
  }
}

}  // namespace lobelia::transfer
