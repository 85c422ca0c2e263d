#include "experiments/reproduce/pictures.h"

#include <fmt/format.h>

#include "experiments/gnuplot.h"
#include "experiments/output_file.h"
#include "sim/check.h"

namespace framesim {

// One line a document, here and in the list below.
std::vector<Picture> robin_hood_pictures(const ReproduceContext& context);
std::vector<Picture> dong_pictures(const ReproduceContext& context);
std::vector<Picture> funkhouser_pictures(const ReproduceContext& context);
std::vector<Picture> zach_pictures(const ReproduceContext& context);
std::vector<Picture> srgge_pictures(const ReproduceContext& context);

namespace {

struct DocumentPictures {
  std::string_view document;
  std::vector<Picture> (*draw)(const ReproduceContext& context);
};
constexpr DocumentPictures kPictures[] = {{"robin-hood", robin_hood_pictures},
                                          {"dong", dong_pictures},
                                          {"funkhouser", funkhouser_pictures},
                                          {"zach", zach_pictures},
                                          {"srgge", srgge_pictures}};

}  // namespace

std::vector<Picture> reproduced_pictures(const ReproducedDocument& document, const ReproduceContext& context) {
  for (const DocumentPictures& entry : kPictures) {
    if (entry.document == document.name) return entry.draw(context);
  }
  FRAMESIM_CHECK(false, fmt::format("'{}' has no pictures", document.name));
  return {};
}

std::vector<std::string> write_pictures(std::span<const Picture> pictures, const std::string& folder) {
  std::vector<std::string> paths;
  for (const Picture& picture : pictures) {
    paths.push_back(fmt::format("{}/{}.svg", folder, picture.name));
    write_file(paths.back(), run_gnuplot(picture.script));
  }
  return paths;
}

}  // namespace framesim
