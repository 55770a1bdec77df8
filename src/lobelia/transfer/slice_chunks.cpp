// Shares and lobes are stored apart: each packs better alone.
#include "lobelia/transfer/slice_chunks.h"

#include <fmt/format.h>

#include <stdexcept>

namespace lobelia::transfer {
namespace {

[[noreturn]] void damaged(const std::string& file, const std::string& what) {
  throw InputError({file}, what + "; make it again with `lobelia precompute --method vmf`");
}

template <class T>
std::span<const T> spanOf(const std::vector<T>& values) {
  return {values.data(), values.size()};
}

void addRecords(std::span<const SliceRecord> records, const std::string& name,
                store::Writer* writer) {
  std::vector<uint32_t> shares, lobes;
  shares.reserve(records.size()), lobes.reserve(records.size());
  for (const SliceRecord record : records)
    shares.push_back(record.share), lobes.push_back(record.lobe);
  writer->add(name + "-s", spanOf(shares));
  writer->add(name + "-l", spanOf(lobes));
}

std::vector<SliceRecord> readRecords(const store::Reader& reader, const std::string& file,
                                     const std::string& name) {
  const auto shares = reader.get<uint32_t>(name + "-s"), lobes = reader.get<uint32_t>(name + "-l");
  if (shares.size() != lobes.size())
    damaged(file,
            fmt::format("'{}' has {} shares for {} lobes", name, shares.size(), lobes.size()));
  std::vector<SliceRecord> records(shares.size());
  for (size_t i = 0; i < records.size(); ++i) records[i] = {shares[i], lobes[i]};
  return records;
}

}  // namespace

void addRows(const SliceRows& rows, const std::string& name, store::Writer* writer) {
  writer->add(name + "-b", rows.bits());
  addRecords(rows.records(), name, writer);
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

void addPass(const TransferPass& pass, const std::string& name, store::Writer* writer) {
  for (size_t c = 0; c < pass.glossy.size(); ++c)
    addRows(pass.glossy[c], fmt::format("{}g{}", name, c), writer);
  addRecords(
      {reinterpret_cast<const SliceRecord*>(pass.diffuse.data()), pass.diffuse.size() * kOctants},
      name + "d", writer);
}

TransferPass readPass(const store::Reader& reader, const std::string& file, const std::string& name,
                      const PassSize& size) {
  TransferPass pass;
  for (size_t c = 0; c < size.classes; ++c)
    pass.glossy.push_back(
        readRows(reader, file, fmt::format("{}g{}", name, c), size.rows, size.columns));
  const std::vector<SliceRecord> records = readRecords(reader, file, name + "d");
  if (!records.empty() && records.size() != size.diffuse * kOctants)
    damaged(file, fmt::format("'{}' has {} diffuse lobes for {} sides of vertices", name,
                              records.size(), size.diffuse));
  pass.diffuse.resize(records.size() / kOctants);
  for (size_t i = 0; i < records.size(); ++i) pass.diffuse[i / kOctants][i % kOctants] = records[i];
  return pass;
}

void addDiffuseSides(const DiffuseSides& sides, store::Writer* writer) {
  const std::vector<uint32_t> backs = sides.backs();
  writer->add("backs", spanOf(backs));
}

DiffuseSides readDiffuseSides(const store::Reader& reader, const std::string& file, size_t rows) {
  try {
    return {rows, reader.get<uint32_t>("backs")};
  } catch (const std::invalid_argument& e) {
    damaged(file, e.what());
  }
}

}  // namespace lobelia::transfer
