// Films in and out. EXR: channel "R" of layer "direct" is "direct.R", the picture's are R, G, B;
// layers of one channel are "depth.Y"; zip-compressed scanlines, 32-bit floats. The encoded file is
// made in memory, because writing it ourselves is the one way to hear of a full disk for certain.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>

#include "lobelia/io/file_bytes.h"
#include "lobelia/io/image_io.h"
#include "lobelia/io/image_pixels.h"

namespace lobelia::io {
namespace {

// "direct.R" -> ("direct", "R")
std::pair<std::string, std::string> splitChannel(const std::string& name) {
  const size_t dot = name.rfind('.');
  return dot == name.npos ? std::pair{std::string(), name}
                          : std::pair{name.substr(0, dot), name.substr(dot + 1)};
}

// A layer's channels in the order in which we keep them.
int channelRank(const std::string& channel) {
  static const std::string kOrder[] = {"R", "r", "X", "x", "U", "Y", "y",
                                       "G", "g", "V", "Z", "z", "B", "b"};
  const auto it = std::find(std::begin(kOrder), std::end(kOrder), channel);
  return static_cast<int>(it - std::begin(kOrder));
}

struct ChannelPlace {
  std::string name;
  size_t index;
};

using ChannelGroups = std::map<std::string, std::vector<ChannelPlace>>;

// Channels beside R, G, B and A ("Z", say) become layers of their own.
void separateExtras(ChannelGroups& layers) {
  ChannelGroups extras;
  for (auto& layer : layers) {
    const std::string& name = layer.first;
    std::vector<ChannelPlace>& places = layer.second;
    const auto has = [&](const char* channel) {
      return std::any_of(places.begin(), places.end(),
                         [&](const ChannelPlace& p) { return p.name == channel; });
    };
    if (!has("R") || !has("G") || !has("B")) continue;
    std::erase_if(places, [&](const ChannelPlace& p) {
      const bool extra = p.name != "R" && p.name != "G" && p.name != "B" && p.name != "A";
      if (extra) extras[name.empty() ? p.name : name + "." + p.name].push_back({"Y", p.index});
      return extra;
    });
  }
  layers.merge(extras);
}

void addLayers(Film& film, const StoredImage& image, bool mainPart) {
  const size_t stride = image.channels.size();
  ChannelGroups layers;
  for (size_t c = 0; c < stride; ++c) {
    auto [layer, channel] = splitChannel(image.channels[c]);
    if (!mainPart && layer.empty()) layer = image.part;
    layers[layer].push_back({channel, c});
  }
  separateExtras(layers);
  for (auto& [name, places] : layers) {
    if (!mainPart && film.layers.contains(name)) continue;
    const auto isAlpha = [](const ChannelPlace& p) { return p.name == "A" || p.name == "a"; };
    const auto alpha = std::find_if(places.begin(), places.end(), isAlpha);
    if (alpha != places.end() && places.size() > 1) {
      if (name.empty())
        for (size_t p = 0; p < film.pixelCount(); ++p)
          film.alpha.push_back(image.pixels[p * stride + alpha->index]);
      places.erase(alpha);  // of other layers: the film has one alpha
    }
    std::stable_sort(places.begin(), places.end(),
                     [](const ChannelPlace& a, const ChannelPlace& b) {
                       return channelRank(a.name) < channelRank(b.name);
                     });
    Layer layer;
    // The picture is RGB, also when the file has it in grey or with further channels.
    const bool picture = name.empty();
    layer.channels = picture ? 3 : static_cast<int>(places.size());
    layer.values.reserve(film.pixelCount() * static_cast<size_t>(layer.channels));
    for (size_t p = 0; p < film.pixelCount(); ++p)
      for (size_t c = 0; c < static_cast<size_t>(layer.channels); ++c)
        layer.values.push_back(
            image.pixels[p * stride + places[places.size() < 3 && picture ? 0 : c].index]);
    film.layers[name] = std::move(layer);
  }
}

// Attributes that describe the encoding, not the picture.
bool isOfTheEncoding(const std::string& key) {
  for (const char* prefix : {"oiio:", "openexr:", "png:", "jpeg:", "Exif:"})
    if (key.starts_with(prefix)) return true;
  return key == "compression" || key == "DateTime" || key == "name" || key == "type";
}

void write(const std::string& file, const char* format, const OIIO::ImageSpec& spec,
           OIIO::TypeDesc type, const void* pixels) {
  OIIO::Filesystem::IOVecOutput memory;
  std::string reason;
  try {
    const std::unique_ptr<OIIO::ImageOutput> out = OIIO::ImageOutput::create(format);
    if (!out) {
      reason = OIIO::geterror();
    } else if (!out->set_ioproxy(&memory) || !out->open(std::string("memory.") + format, spec) ||
               !out->write_image(type, pixels) || !out->close()) {
      reason = out->geterror();
    } else {
      const auto& bytes = memory.buffer();
      writeFileAtomically(file, std::string(bytes.begin(), bytes.end()));
      return;
    }
  } catch (const RuntimeError&) {
    throw;
  } catch (const std::exception& error) {
    reason = error.what();
  }
  throw RuntimeError(fmt::format("cannot write '{}': {}", file, reason));
}

std::vector<std::string> channelNames(const std::string& layer, int count) {
  static constexpr const char* kRgb[] = {"R", "G", "B"};
  std::vector<std::string> names;
  const std::string prefix = layer.empty() ? "" : layer + ".";
  for (int c = 0; c < count; ++c)
    names.push_back(prefix + (count == 1 ? "Y" : count <= 3 ? kRgb[c] : fmt::format("c{:03}", c)));
  return names;
}

void require(bool right, const std::string& file, const std::string& what) {
  if (!right) throw RuntimeError(fmt::format("cannot write '{}': {}", file, what));
}

}  // namespace

Film readFilm(const std::string& file) {
  std::vector<StoredImage> images = readStoredImages(file, true, {});
  const StoredImage& first = images.front();
  Film film;
  film.fullWidth = first.fullWidth, film.fullHeight = first.fullHeight;
  film.x0 = first.x0, film.y0 = first.y0;
  film.width = first.width, film.height = first.height;
  for (const auto& [key, value] : first.metadata)
    if (!isOfTheEncoding(key)) film.metadata[key] = value;
  for (StoredImage& image : images) {
    // Further parts are layers when they cover the same pixels (else previews and the like).
    if (image.width != film.width || image.height != film.height || image.x0 != film.x0 ||
        image.y0 != film.y0)
      continue;
    addLayers(film, image, &image == &images.front());
  }
  if (!film.layers.contains("")) {
    // Only named layers: the first with colour is the picture.
    for (const auto& [name, layer] : film.layers)
      if (layer.channels >= 3 && !film.layers.contains("")) film.layers[""] = layer;
    if (!film.layers.contains(""))
      throw InputError({file, 0, 0}, "no layer with colour; a picture needs R, G and B");
  }
  film.forDisplay = first.integerBits == 8 || first.integerBits == 16;
  if (film.forDisplay)
    for (auto& [name, layer] : film.layers)
      for (float& v : layer.values) v = decodeSrgb(v);
  return film;
}

void writeExr(const std::string& file, const Film& film) {
  require(film.width > 0 && film.height > 0, file, "the film is empty");
  std::vector<std::string> names;
  std::vector<std::pair<const std::vector<float>*, size_t>> sources;  // values, channels
  for (const auto& [name, layer] : film.layers) {
    require(layer.channels > 0 &&
                layer.values.size() == film.pixelCount() * static_cast<size_t>(layer.channels),
            file, fmt::format("layer '{}' has not the film's size", name));
    for (const std::string& channel : channelNames(name, layer.channels)) names.push_back(channel);
    sources.emplace_back(&layer.values, static_cast<size_t>(layer.channels));
  }
  if (!film.alpha.empty()) {
    require(film.alpha.size() == film.pixelCount(), file, "alpha has not the film's size");
    names.emplace_back("A");
    sources.emplace_back(&film.alpha, size_t{1});
  }
  require(!names.empty(), file, "the film has no layers");
  std::vector<float> pixels;
  pixels.reserve(film.pixelCount() * names.size());
  for (size_t p = 0; p < film.pixelCount(); ++p)
    for (const auto& [values, channels] : sources)
      for (size_t c = 0; c < channels; ++c) pixels.push_back((*values)[p * channels + c]);

  OIIO::ImageSpec spec(film.width, film.height, static_cast<int>(names.size()), OIIO::TypeFloat);
  spec.x = film.x0, spec.y = film.y0;
  spec.full_x = 0, spec.full_y = 0;
  spec.full_width = film.fullWidth > 0 ? film.fullWidth : film.width;
  spec.full_height = film.fullHeight > 0 ? film.fullHeight : film.height;
  spec.channelnames.assign(names.begin(), names.end());
  spec.attribute("compression", "zip");
  spec.attribute("oiio:ColorSpace", "Linear");
  for (const auto& [key, value] : film.metadata) spec.attribute(key, value);
  write(file, "openexr", spec, OIIO::TypeFloat, pixels.data());
}

void writePng(const std::string& file, const std::vector<uint8_t>& pixels, int width, int height,
              int channels) {
  const bool right = width > 0 && height > 0 && (channels == 1 || channels == 3 || channels == 4) &&
                     pixels.size() == static_cast<size_t>(channels) * static_cast<size_t>(width) *
                                          static_cast<size_t>(height);
  require(right, file,
          fmt::format("{} bytes are no image of {} x {} pixels with {} channels", pixels.size(),
                      width, height, channels));
  OIIO::ImageSpec spec(width, height, channels, OIIO::TypeUInt8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("oiio:UnassociatedAlpha", 1);
  write(file, "png", spec, OIIO::TypeUInt8, pixels.data());
}

}  // namespace lobelia::io
