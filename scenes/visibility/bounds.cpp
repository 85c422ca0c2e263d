#include "scenes/visibility/bounds.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <glm/common.hpp>
#include <limits>

#include "sim/check.h"

namespace framesim {
namespace {

constexpr std::uint32_t kLeafRows = 8;
// A box decides for all its spheres; this much of its size keeps rounding from deciding otherwise than each sphere
// would.
constexpr double kSlack = 1e-12;

}  // namespace

Meeting meet_sphere(std::span<const Plane> volume, const glm::dvec3& centre, double radius) {
  Meeting result = Meeting::inside;
  for (const Plane& plane : volume) {
    const double distance = plane_distance(plane, centre);
    if (distance < -radius) return Meeting::outside;
    if (distance < radius) result = Meeting::crosses;
  }
  return result;
}

namespace {

// Calls visit(i) for each bit i of `words` that is set, ascending.
template <class Visit>
void for_each_bit(std::span<const std::uint64_t> words, Visit visit) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    for (std::uint64_t word = words[i]; word != 0; word &= word - 1) {
      visit(i * 64 + static_cast<std::size_t>(std::countr_zero(word)));
    }
  }
}

}  // namespace

void RowMarks::resize(std::size_t rows) {
  words_.assign((rows + 63) / 64, 0);
  used_.assign((words_.size() + 63) / 64, 0);
}

std::size_t RowMarks::count() const {
  std::size_t count = 0;
  for_each_bit(used_, [&](std::size_t word) { count += static_cast<std::size_t>(std::popcount(words_[word])); });
  return count;
}

void RowMarks::drain(std::vector<std::uint32_t>& rows) {
  rows.resize(count());
  std::uint32_t* next = rows.data();
  for_each_bit(used_, [&](std::size_t i) {
    const auto first = static_cast<std::uint32_t>(i * 64);
    for (std::uint64_t word = words_[i]; word != 0; word &= word - 1) {
      *next++ = first + static_cast<std::uint32_t>(std::countr_zero(word));
    }
    words_[i] = 0;
  });
  std::fill(used_.begin(), used_.end(), 0);
}

BoundsTree::BoundsTree(const Instances& instances, std::vector<std::uint32_t> rows) : rows_(std::move(rows)) {
  if (rows_.empty()) return;
  nodes_.reserve(rows_.size() / (kLeafRows / 2) + 1);
  build(instances, 0, static_cast<std::uint32_t>(rows_.size()));
  for (const std::uint32_t row : rows_) {
    centres_.push_back(instances.centre[row]);
    radii_.push_back(static_cast<double>(instances.radius_m[row]));
  }
}

std::uint32_t BoundsTree::build(const Instances& instances, std::uint32_t first, std::uint32_t last) {
  const auto infinity = std::numeric_limits<double>::infinity();
  glm::dvec3 low(infinity), high(-infinity), least(infinity), most(-infinity);
  for (std::uint32_t i = first; i < last; ++i) {
    const glm::dvec3& centre = instances.centre[rows_[i]];
    const double radius = static_cast<double>(instances.radius_m[rows_[i]]);
    low = glm::min(low, centre - radius);
    high = glm::max(high, centre + radius);
    least = glm::min(least, centre);
    most = glm::max(most, centre);
  }
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({(low + high) * 0.5, (high - low) * 0.5, first, last, 0});
  if (last - first <= kLeafRows) return index;
  const glm::dvec3 spread = most - least;
  const int axis = spread.x >= spread.y && spread.x >= spread.z ? 0 : (spread.y >= spread.z ? 1 : 2);
  const std::uint32_t middle = first + (last - first) / 2;
  std::nth_element(rows_.begin() + first, rows_.begin() + middle, rows_.begin() + last,
                   [&](std::uint32_t a, std::uint32_t b) {
                     const double at = instances.centre[a][axis], bt = instances.centre[b][axis];
                     return at != bt ? at < bt : a < b;
                   });
  build(instances, first, middle);
  const std::uint32_t right = build(instances, middle, last);
  nodes_[index].right = right;
  return index;
}

std::int64_t BoundsTree::collect(std::span<const Plane> volume, RowMarks& marks) const {
  FRAMESIM_CHECK(volume.size() <= 64, fmt::format("{} planes", volume.size()));
  if (nodes_.empty()) return 0;
  const std::uint64_t all = volume.size() == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << volume.size()) - 1;
  return descend(0, volume, all, marks);
}

// `planes` are those that the parent's box crosses: the others have it wholly inside, and so all below it.
std::int64_t BoundsTree::descend(std::uint32_t index, std::span<const Plane> volume, std::uint64_t planes,
                                 RowMarks& marks) const {
  const Node& node = nodes_[index];
  for (std::uint64_t left = planes; left != 0; left &= left - 1) {
    const int bit = std::countr_zero(left);
    const Plane& plane = volume[static_cast<std::size_t>(bit)];
    const double reach = glm::dot(glm::abs(plane.normal), node.extent);
    const double distance = plane_distance(plane, node.centre);
    const double slack = kSlack * (reach + glm::dot(glm::abs(plane.normal), glm::abs(node.centre)));
    if (distance < -reach - slack) return 1;
    if (distance > reach + slack) planes &= ~(std::uint64_t{1} << bit);
  }
  if (planes == 0) {
    for (std::uint32_t i = node.first; i < node.last; ++i) marks.mark(rows_[i]);
    return 1;
  }
  if (node.right != 0) {
    return 1 + descend(index + 1, volume, planes, marks) + descend(node.right, volume, planes, marks);
  }
  for (std::uint32_t i = node.first; i < node.last; ++i) {
    bool meets = true;
    for (std::uint64_t left = planes; left != 0 && meets; left &= left - 1) {
      meets = !(plane_distance(volume[static_cast<std::size_t>(std::countr_zero(left))], centres_[i]) < -radii_[i]);
    }
    if (meets) marks.mark(rows_[i]);
  }
  return 1 + static_cast<std::int64_t>(node.last - node.first);
}

}  // namespace framesim
