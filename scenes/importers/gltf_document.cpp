#include "scenes/importers/gltf_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

#include "sim/words.h"

namespace framesim {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian; so is what reads it here");

constexpr double kMostCount = 4294967295.0;

std::uint32_t word_at(std::string_view data, std::size_t offset) {
  std::uint32_t word = 0;
  std::memcpy(&word, data.data() + offset, sizeof word);
  return word;
}

struct Component {
  std::size_t code, bytes;
  double largest;  // of normalised integers; 0: not an integer
};
constexpr Component kComponents[] = {{5120, 1, 127},   {5121, 1, 255}, {5122, 2, 32767},
                                     {5123, 2, 65535}, {5125, 4, 0},   {5126, 4, 0}};

template <class T>
double read_as(const char* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return static_cast<double>(value);
}

double component_at(const char* at, std::size_t code) {
  switch (code) {
    case 5120:
      return read_as<std::int8_t>(at);
    case 5121:
      return read_as<std::uint8_t>(at);
    case 5122:
      return read_as<std::int16_t>(at);
    case 5123:
      return read_as<std::uint16_t>(at);
    case 5125:
      return read_as<std::uint32_t>(at);
    default:
      return read_as<float>(at);
  }
}

std::size_t components_of(std::string_view type) {
  return type == "SCALAR" ? 1 : type == "VEC2" ? 2 : type == "VEC3" ? 3 : 4;
}

std::optional<std::string> decode_base64(std::string_view text) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  unsigned bits = 0, count = 0;
  while (text.ends_with('=')) text.remove_suffix(1);
  for (const char c : text) {
    const std::size_t digit = kDigits.find(c);
    if (digit == std::string_view::npos) return std::nullopt;
    bits = (bits << 6 | static_cast<unsigned>(digit)) & 0xffffff;
    count += 6;
    if (count < 8) continue;
    count -= 8;
    out += static_cast<char>(bits >> count & 0xff);
  }
  return out;
}

// Primitives that `n` indices or vertices make in a mode of glTF.
void add_primitives(std::size_t mode, double n, ImportedFacts& facts) {
  if (mode == 0) facts.points += n;
  if (mode == 1) facts.lines += std::floor(n / 2);
  if (mode == 2) facts.lines += n;
  if (mode == 3) facts.lines += std::max(0.0, n - 1);
  if (mode == 4) facts.polygons += std::floor(n / 3);
  if (mode == 5 || mode == 6) facts.polygons += std::max(0.0, n - 2);
}

}  // namespace

void ImportedBox::add(const glm::dvec3& point) {
  low = glm::min(low, point);
  high = glm::max(high, point);
}

void ImportedBox::add(const ImportedBox& other, const glm::dmat4& transform) {
  if (other.empty()) return;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec4 point(corner & 1 ? other.high.x : other.low.x, corner & 2 ? other.high.y : other.low.y,
                           corner & 4 ? other.high.z : other.low.z, 1);
    add(glm::dvec3(transform * point));
  }
}

double ImportedBox::radius() const { return std::max(glm::length(high - low) / 2, 1e-6); }

double ImportedBox::mean_projected_area() const {
  const glm::dvec3 d = high - low;
  return std::max((d.x * d.y + d.y * d.z + d.z * d.x) / 2, 1e-12);
}

GltfDocument::GltfDocument(std::string_view data, const std::string& file, FilesBeside& files)
    : file_(file), files_(files), data_(data) {
  std::string_view text = data_;
  if (text.starts_with("glTF")) {
    split_binary(data_);
    text = json_text_;
  }
  json_ = parse_json(text, file_);
  const JsonValue version = root().need("asset").need("version");
  if (!version.text().starts_with("2."))
    version.refuse(fmt::format("found {}; expected 2.0", framesim::quoted(version.text())));
  buffers_.resize(count("buffers"));
  bytes_read_ = data_.size();
}

void GltfDocument::split_binary(std::string_view data) {
  const auto refuse = [&](const std::string& why) { throw InputError({file_}, "not a binary glTF: " + why); };
  if (data.size() < 20) refuse(fmt::format("{} bytes; its headers take 20", data.size()));
  if (word_at(data, 4) != 2) refuse(fmt::format("version {}; expected 2", word_at(data, 4)));
  if (word_at(data, 8) > data.size()) refuse(fmt::format("it says {} bytes and has {}", word_at(data, 8), data.size()));
  data = data.substr(0, word_at(data, 8));
  std::size_t at = 12;
  for (int chunk = 0; at + 8 <= data.size(); ++chunk) {
    const std::size_t length = word_at(data, at), kind = word_at(data, at + 4);
    if (length > data.size() - at - 8) refuse(fmt::format("chunk {} at byte {} is longer than the file", chunk, at));
    const std::string_view content = data.substr(at + 8, length);
    if (chunk == 0 && kind != 0x4e4f534a) refuse("its first chunk is not JSON");
    if (chunk == 0) json_text_ = content;
    if (chunk == 1 && kind == 0x004e4942) binary_ = content;
    at += 8 + length;
  }
  if (json_text_.empty()) refuse("it has no JSON chunk");
}

std::size_t GltfDocument::count(std::string_view array) const {
  const auto found = root().find(array);
  return found ? found->size() : 0;
}

JsonValue GltfDocument::element(std::string_view array, std::size_t index) const {
  return root().need(array).at(index);
}

MeshFacts GltfDocument::mesh(std::size_t index, ImportedScene& notes) const {
  MeshFacts result;
  const JsonValue primitives = element("meshes", index).need("primitives");
  for (std::size_t i = 0; i < primitives.size(1); ++i) {
    const JsonValue primitive = primitives.at(i);
    const auto attributes = primitive.need("attributes");
    const auto mode = primitive.find("mode");
    const auto position = attributes.find("POSITION");
    if (!position) {
      notes.note("primitives without POSITION are left out");
      continue;
    }
    const JsonValue accessor = element("accessors", position->index(count("accessors"), "accessors"));
    const double vertices = static_cast<double>(accessor.need("count").whole(1, static_cast<std::size_t>(kMostCount)));
    double drawn = vertices;
    if (const auto indices = primitive.find("indices")) {
      const JsonValue list = element("accessors", indices->index(count("accessors"), "accessors"));
      drawn = static_cast<double>(list.need("count").whole(1, static_cast<std::size_t>(kMostCount)));
    }
    add_primitives(mode ? mode->whole(0, 6) : 4, drawn, result.facts);
    result.facts.vertices += vertices;
    result.facts.draws += 1;
    const auto low = accessor.need("min").numbers(3), high = accessor.need("max").numbers(3);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool fine = low[axis] <= high[axis] && std::abs(low[axis]) < 1e9 && std::abs(high[axis]) < 1e9;
      if (!fine) accessor.refuse(fmt::format("min and max of axis {} are {} and {}", axis, low[axis], high[axis]));
    }
    result.box.add({low[0], low[1], low[2]});
    result.box.add({high[0], high[1], high[2]});
  }
  return result;
}

const std::string& GltfDocument::buffer(std::size_t index, const JsonValue& at) {
  std::optional<std::string>& content = buffers_[index];
  if (content) return *content;
  const JsonValue json = element("buffers", index);
  const auto uri = json.find("uri");
  if (!uri) {
    if (index > 0 || binary_.data() == nullptr) json.refuse("has no uri, and there is no binary chunk");
    content = std::string(binary_);
  } else if (uri->text().starts_with("data:")) {
    const std::size_t comma = uri->text().find(";base64,");
    if (comma != std::string::npos) content = decode_base64(std::string_view(uri->text()).substr(comma + 8));
    if (!content) uri->refuse("a data URI that is not base64");
  } else {
    content = files_.read(uri->text(), [&](const std::string& why) { uri->refuse(why); });
    if (!content) at.refuse(fmt::format("needs the buffer {}, which is not there", framesim::quoted(uri->text())));
  }
  bytes_read_ += content->size();
  return *content;
}

std::vector<double> GltfDocument::values(const JsonValue& accessor_index, std::string_view type) {
  const JsonValue accessor = element("accessors", accessor_index.index(count("accessors"), "accessors"));
  const JsonValue kind = accessor.need("type");
  if (kind.text() != type) kind.refuse(fmt::format("found {}; expected {}", framesim::quoted(kind.text()), type));
  if (accessor.find("sparse")) accessor.refuse("sparse accessors are not read");
  const std::size_t code = accessor.need("componentType").whole(5120, 5126);
  const auto component =
      std::find_if(std::begin(kComponents), std::end(kComponents), [&](const Component& c) { return c.code == code; });
  if (component == std::end(kComponents))
    accessor.need("componentType").refuse(fmt::format("there is no type {}", code));
  const JsonValue view =
      element("bufferViews", accessor.need("bufferView").index(count("bufferViews"), "buffer views"));
  const JsonValue buffer_index = view.need("buffer");
  const std::string& bytes = buffer(buffer_index.index(count("buffers"), "buffers"), accessor);
  const auto offset_in = [&](const JsonValue& json) {
    const auto offset = json.find("byteOffset");
    return offset ? offset->whole(0, kLargestImport) : 0;
  };
  const std::size_t width = components_of(type), element_bytes = width * component->bytes;
  const auto stride_given = view.find("byteStride");
  const std::size_t stride = stride_given ? stride_given->whole(element_bytes, 252) : element_bytes;
  const std::size_t begin = offset_in(view) + offset_in(accessor);
  const std::size_t n = accessor.need("count").whole(1, kLargestImport);
  if (begin > bytes.size() || (n - 1) * stride + element_bytes > bytes.size() - begin)
    accessor.refuse(
        fmt::format("reaches byte {} of a buffer of {}", begin + (n - 1) * stride + element_bytes, bytes.size()));
  std::vector<double> out(n * width);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t c = 0; c < width; ++c) {
      double value = component_at(bytes.data() + begin + i * stride + c * component->bytes, code);
      if (component->largest > 0) value = std::max(-1.0, value / component->largest);
      if (!std::isfinite(value) || std::abs(value) > 1e12)
        accessor.refuse(fmt::format("value {} of element {} is {}", c, i, value));
      out[i * width + c] = value;
    }
  }
  return out;
}

}  // namespace framesim
