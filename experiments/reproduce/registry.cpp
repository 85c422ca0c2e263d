// The documents, in the order in which they are printed. To add one: a file that defines its entry, and its two lines
// here.
#include <vector>

#include "experiments/reproduce/reproduce.h"

namespace framesim {

ReproducedDocument robin_hood_document();
ReproducedDocument dong_document();
ReproducedDocument funkhouser_document();
ReproducedDocument zach_document();
ReproducedDocument srgge_document();

std::span<const ReproducedDocument> reproduced_documents() {
  static const std::vector<ReproducedDocument> kDocuments = {
      robin_hood_document(), dong_document(), funkhouser_document(), zach_document(), srgge_document(),
  };
  return kDocuments;
}

Reproduction reproduce(const ReproducedDocument& document, const ReproduceContext& context) {
  Reproduction result{.document = std::string(document.name), .title = std::string(document.title)};
  document.reproduce(context, result);
  return result;
}

}  // namespace framesim
