#include <cmath>

#include "experiments/reproduce/reproduce.h"

namespace framesim {
namespace {

// A figure is printed with so many digits: a difference of half a unit in the sixth digit is rounding.
constexpr double kRounding = 1e-9;

bool meets(const ReproducedRow& row) {
  const double value = row.target->value;
  switch (row.target->kind) {
    case ReproduceTarget::Kind::at_least:
      return row.simulated >= value;
    case ReproduceTarget::Kind::at_most:
      return row.simulated <= value;
    case ReproduceTarget::Kind::relative:
      return std::abs(row.simulated - *row.published) <= value * std::abs(*row.published) + kRounding;
    case ReproduceTarget::Kind::absolute:
      break;
  }
  return std::abs(row.simulated - *row.published) <= value + kRounding;
}

bool needs_published(const ReproduceTarget& target) {
  return target.kind == ReproduceTarget::Kind::relative || target.kind == ReproduceTarget::Kind::absolute;
}

}  // namespace

Verdict verdict(const ReproducedRow& row) {
  if (!row.target || (needs_published(*row.target) && !row.published)) return Verdict::no_target;
  if (std::isnan(row.simulated)) return Verdict::outside;
  return meets(row) ? Verdict::inside : Verdict::outside;
}

bool is_relative(const ReproducedRow& row) {
  if (!row.published || *row.published == 0) return false;
  if (row.target && row.target->kind == ReproduceTarget::Kind::absolute) return false;
  return (row.target && row.target->kind == ReproduceTarget::Kind::relative) || row.unit == "s" || row.unit == "fps";
}

std::optional<double> difference(const ReproducedRow& row) {
  if (!row.published) return std::nullopt;
  const double absolute = row.simulated - *row.published;
  return is_relative(row) ? absolute / std::abs(*row.published) : absolute;
}

}  // namespace framesim
