// Parsing of Mitsuba's XML by pugixml into elements with places.
//
// Mitsuba 3 (src/core/xml.cpp) and Mitsuba 0.6 agree on what happens here: <default> sets a
// parameter unless the command line has, <include> puts the children of another file's <scene> in
// its place, <path> adds a folder in front of the search path, <alias> gives an id a second name.
// Deviations: an undefined parameter is an error only where its value is used (the integrator and
// the sampler are hints), an unknown element is a warning, and files are also sought beside the XML
// file that names them.

#include "lobelia/io/mitsuba/xml.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <pugixml.hpp>
#include <set>
#include <sstream>

#include "lobelia/io/mitsuba/tags.h"

namespace lobelia::io::mitsuba {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxNesting = 64;
constexpr int kMaxIncludes = 32;

// Byte offsets to lines and columns.
class Lines {
 public:
  Lines(std::string file, std::string_view text) : file_(std::move(file)) {
    for (size_t i = 0; i < text.size(); ++i) {
      if (text[i] == '\n') starts_.push_back(i + 1);
    }
  }
  Location at(ptrdiff_t offset) const {
    if (offset < 0) return {file_, 0, 0};
    const auto next = std::upper_bound(starts_.begin(), starts_.end(), static_cast<size_t>(offset));
    const auto line = next - starts_.begin();
    return {file_, static_cast<int>(line),
            static_cast<int>(static_cast<size_t>(offset) - *(next - 1)) + 1};
  }

 private:
  std::string file_;
  std::vector<size_t> starts_{0};
};

std::string readText(const std::string& file, const Location& from) {
  std::error_code error;
  if (!fs::exists(file, error)) {
    const std::string sought =
        fs::path(file).is_absolute() ? "" : " in " + fs::current_path(error).string();
    throw InputError(from, "the file '" + file + "' does not exist" + sought);
  }
  if (fs::is_directory(file, error)) {
    throw InputError(from, "'" + file + "' is a folder; name the scene's .xml file");
  }
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in || in.bad()) throw InputError(from, "the file '" + file + "' cannot be read");
  return std::move(text).str();
}

bool isLegacyVersion(const pugi::xml_node& root, const Location& where, Findings& findings) {
  const pugi::xml_attribute attribute = root.attribute("version");
  if (!attribute) {
    findings.warn(where, "<scene> has no version; it is read as Mitsuba 3.0.0");
    return false;
  }
  const std::string text = attribute.value();
  const bool valid = !text.empty() && std::isdigit(static_cast<unsigned char>(text[0])) &&
                     text.find_first_not_of("0123456789.") == std::string::npos && text.size() < 20;
  if (!valid) {
    throw InputError(where, "the version '" + text + "' is not a version such as 0.6.0 or 3.0.0");
  }
  return text[0] == '0' || text.rfind("1.", 0) == 0;
}

class Loader {
 public:
  Loader(Document& document, std::map<std::string, std::string> parameters, Findings& findings)
      : document_(document), parameters_(std::move(parameters)), findings_(findings) {}

  void load(const std::string& file) {
    for (const auto& [name, value] : parameters_) unused_.insert(name);
    document_.searchPaths = {fs::path(file).parent_path().string()};
    readFile(file, {}, document_.scene, 0);
    std::vector<std::string> known = keysOf(parameters_);
    std::erase_if(known, [&](const std::string& name) { return unused_.contains(name); });
    for (const std::string& name : unused_) {
      findings_.warn({file, 0, 0}, "the scene has no parameter '" + name + "' to define" +
                                       suggestion(name, known));
    }
    collectIds(document_.scene);
    for (const auto& [id, target, where] : aliases_) addAlias(id, target, where);
  }

 private:
  struct Alias {
    std::string as, id;
    Location where;
  };

  static std::vector<std::string> keysOf(const std::map<std::string, std::string>& map) {
    std::vector<std::string> keys;
    for (const auto& [key, value] : map) keys.push_back(key);
    return keys;
  }

  void readFile(const std::string& file, const Location& from, Element& into, int nesting) {
    std::error_code error;
    const std::string canonical = fs::weakly_canonical(file, error).string();
    for (size_t i = 0; i < open_.size(); ++i) {
      if (open_[i].first != canonical) continue;
      std::string chain;
      for (size_t j = i; j < open_.size(); ++j) chain += open_[j].second + " -> ";
      throw InputError(from, "the files include each other in a circle: " + chain + file);
    }
    if (open_.size() > kMaxIncludes) {
      throw InputError(
          from, "files are included more than " + std::to_string(kMaxIncludes) + " levels deep");
    }
    open_.emplace_back(canonical, file);
    const std::string text = readText(file, from);
    const Lines lines(file, text);
    pugi::xml_document xml;
    const pugi::xml_parse_result result = xml.load_buffer(text.data(), text.size());
    if (!result) {
      throw InputError(lines.at(result.offset),
                       std::string("not well-formed XML: ") + result.description());
    }
    const pugi::xml_node root = xml.document_element();
    const Location where = lines.at(root.offset_debug());
    if (std::strcmp(root.name(), "scene") != 0) {
      throw InputError(where, std::string("the root element is <") + root.name() +
                                  ">; a Mitsuba file has <scene version=\"...\">");
    }
    const bool legacy = isLegacyVersion(root, where, findings_);
    if (into.tag.empty()) {
      into.tag = "scene";
      into.where = where;
      into.legacy = legacy;
    }
    readChildren(root, lines, legacy, into, nesting);
    open_.pop_back();
  }

  void readChildren(const pugi::xml_node& node, const Lines& lines, bool legacy, Element& into,
                    int nesting) {
    if (nesting > kMaxNesting) {
      throw InputError(into.where, "elements are nested more than " + std::to_string(kMaxNesting) +
                                       " levels deep");
    }
    for (const pugi::xml_node& child : node.children()) {
      const Location where = lines.at(child.offset_debug());
      if (child.type() == pugi::node_pcdata || child.type() == pugi::node_cdata) {
        findings_.warn(where, "text outside of an element's attributes is ignored");
      } else if (child.type() == pugi::node_element) {
        readElement(child, where, lines, legacy, into, nesting);
      }
    }
  }

  void readElement(const pugi::xml_node& node, const Location& where, const Lines& lines,
                   bool legacy, Element& parent, int nesting) {
    Element element;
    element.tag = normalTag(node.name());
    element.where = where;
    element.legacy = legacy;
    const Tag* tag = findTag(element.tag);
    if (!tag) {
      std::vector<std::string> names;
      for (const Tag& t : knownTags()) names.emplace_back(t.name);
      findings_.warn(where, "unknown element <" + element.tag + "> is ignored" +
                                suggestion(element.tag, names));
      return;
    }
    for (const pugi::xml_attribute& a : node.attributes()) {
      Attribute attribute{a.name(), a.value(), {}};
      substitute(attribute);
      if (std::find(tag->attributes.begin(), tag->attributes.end(), attribute.name) ==
          tag->attributes.end()) {
        findings_.warn(where, "unknown attribute '" + attribute.name + "' of <" + element.tag +
                                  "> is ignored" + suggestion(attribute.name, tag->attributes));
        continue;
      }
      element.attributes.push_back(std::move(attribute));
    }
    element.name = snakeCase(element.valueOr("name", ""));
    if (element.tag == "default") {
      parameters_.emplace(element.value("name"), element.value("value"));
      unused_.erase(element.value("name"));
    } else if (element.tag == "path") {
      addPath(element);
    } else if (element.tag == "alias") {
      aliases_.push_back({element.value("as"), element.value("id"), where});
    } else if (element.tag == "include") {
      readFile(document_.resolve(element.value("filename"), where), where, parent, nesting + 1);
    } else {
      readChildren(node, lines, legacy, element, nesting + 1);
      parent.children.push_back(std::move(element));
    }
  }

  // Replaces $name by its value; of several names that fit the longest.
  void substitute(Attribute& attribute) {
    std::string out;
    const std::string& in = attribute.value;
    for (size_t i = 0; i < in.size();) {
      if (in[i] != '$') {
        out += in[i++];
        continue;
      }
      const std::pair<const std::string, std::string>* best = nullptr;
      for (const auto& parameter : parameters_) {
        if (in.compare(i + 1, parameter.first.size(), parameter.first) == 0 &&
            (!best || parameter.first.size() > best->first.size())) {
          best = &parameter;
        }
      }
      if (best && !best->first.empty()) {
        out += best->second;
        unused_.erase(best->first);
        i += 1 + best->first.size();
        continue;
      }
      size_t end = i + 1;
      while (end < in.size() &&
             (std::isalnum(static_cast<unsigned char>(in[end])) || in[end] == '_')) {
        ++end;
      }
      if (attribute.undefined.empty()) attribute.undefined = in.substr(i + 1, end - i - 1);
      out += in.substr(i, end - i);
      i = end;
    }
    attribute.value = std::move(out);
  }

  void addPath(const Element& element) {
    const fs::path given = element.value("value");
    const fs::path beside = fs::path(element.where.file).parent_path() / given;
    const fs::path path = given.is_absolute() ? given : beside;
    std::error_code error;
    if (!fs::is_directory(path, error)) {
      throw InputError(element.where, "<path>: there is no folder '" + path.string() + "'");
    }
    document_.searchPaths.insert(document_.searchPaths.begin(), path.string());
  }

  void collectIds(const Element& element) {
    if (findTag(element.tag)->object || element.tag == "spectrum") {
      if (const std::string id = element.valueOr("id", ""); !id.empty()) add(id, element);
    }
    for (const Element& child : element.children) collectIds(child);
  }

  void add(const std::string& id, const Element& element) {
    const auto [at, inserted] = document_.byId.emplace(id, &element);
    if (!inserted) {
      throw InputError(element.where, "the id '" + id + "' is used twice; it was first given at " +
                                          toString(at->second->where));
    }
  }

  void addAlias(const std::string& as, const std::string& id, const Location& where) {
    const auto target = document_.byId.find(id);
    if (target == document_.byId.end()) {
      std::vector<std::string> ids;
      for (const auto& [known, element] : document_.byId) ids.push_back(known);
      throw InputError(where, "<alias>: nothing has the id '" + id + "'" + suggestion(id, ids));
    }
    if (!document_.byId.emplace(as, target->second).second) {
      throw InputError(where, "<alias>: the id '" + as + "' is used already");
    }
  }

  Document& document_;
  std::map<std::string, std::string> parameters_;
  Findings& findings_;
  std::vector<std::pair<std::string, std::string>> open_;  // canonical path, path as written
  std::set<std::string> unused_;
  std::vector<Alias> aliases_;
};

}  // namespace

const Attribute* Element::find(std::string_view attribute) const {
  for (const Attribute& a : attributes) {
    if (a.name == attribute) return &a;
  }
  return nullptr;
}

const std::string& Element::value(std::string_view attribute) const {
  const Attribute* a = find(attribute);
  if (!a) {
    throw InputError(where, "<" + tag + "> lacks the attribute '" + std::string(attribute) + "'");
  }
  if (!a->undefined.empty()) {
    throw InputError(where, "the parameter $" + a->undefined + " has no value; give one with -D " +
                                a->undefined + "=... or <default>");
  }
  return a->value;
}

std::string Element::valueOr(std::string_view attribute, std::string_view otherwise) const {
  return has(attribute) ? value(attribute) : std::string(otherwise);
}

std::string Document::resolve(const std::string& file, const Location& from) const {
  const fs::path path = file;
  std::error_code error;
  std::vector<fs::path> candidates;
  if (path.is_absolute()) {
    candidates.push_back(path);
  } else {
    for (const std::string& folder : searchPaths) candidates.push_back(folder / path);
    candidates.push_back(fs::path(from.file).parent_path() / path);
  }
  for (const fs::path& candidate : candidates) {
    if (fs::is_regular_file(candidate, error)) return candidate.string();
  }
  std::string sought;
  for (const std::string& folder : searchPaths) {
    sought += (sought.empty() ? "" : ", ") + (folder.empty() ? std::string(".") : folder);
  }
  throw InputError(from, "there is no file '" + file + "'" +
                             (path.is_absolute() ? "" : "; it was sought in " + sought));
}

Document loadDocument(const std::string& file,
                      const std::map<std::string, std::string>& definitions, Findings& findings) {
  Document document;
  Loader(document, definitions, findings).load(file);
  return document;
}

std::string snakeCase(std::string_view name) {
  std::string out;
  for (size_t i = 0; i < name.size(); ++i) {
    const auto c = static_cast<unsigned char>(name[i]);
    if (std::isupper(c)) {
      const bool afterLower = i > 0 && (std::islower(static_cast<unsigned char>(name[i - 1])) ||
                                        std::isdigit(static_cast<unsigned char>(name[i - 1])));
      if (afterLower) out += '_';
      out += static_cast<char>(std::tolower(c));
    } else {
      out += name[i];
    }
  }
  return out;
}

}  // namespace lobelia::io::mitsuba
