#include "scenes/generators/noise.h"

#include <algorithm>
#include <cmath>

namespace framesim {
namespace {

double smooth(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

// Where a point lies between two lattice points.
struct Place {
  std::size_t index = 0;
  double weight = 0;  // of the upper one
};

std::vector<Place> places(std::size_t n, double first, double step, std::size_t cells) {
  std::vector<Place> result(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double at = (first + step * static_cast<double>(i)) * static_cast<double>(cells);
    const double cell = std::clamp(std::floor(at), 0.0, static_cast<double>(cells - 1));
    result[i] = {static_cast<std::size_t>(cell), smooth(std::clamp(at - cell, 0.0, 1.0))};
  }
  return result;
}

}  // namespace

SmoothField::SmoothField(std::uint64_t seed, std::string_view name, int lattice, int octaves)
    : random_(seed, name), lattice_(lattice), octaves_(octaves) {}

std::vector<float> SmoothField::sample(std::size_t n, double first, double step) const {
  std::vector<float> field(n * n, 0.0f);
  double whole = 0;
  for (int octave = 0; octave < octaves_; ++octave) whole += std::ldexp(1.0, -octave);
  for (int octave = 0; octave < octaves_; ++octave) {
    const std::size_t cells = static_cast<std::size_t>(lattice_) << octave;
    const double weight = std::ldexp(1.0, -octave) / whole;
    std::vector<double> lattice((cells + 1) * (cells + 1));
    for (std::size_t i = 0; i < lattice.size(); ++i) {
      lattice[i] = weight * random_.uniform(static_cast<std::uint64_t>(octave), static_cast<std::uint32_t>(i));
    }
    const std::vector<Place> at = places(n, first, step, cells);
    std::vector<double> row(cells + 1);
    for (std::size_t j = 0; j < n; ++j) {
      const double* low = &lattice[at[j].index * (cells + 1)];
      for (std::size_t c = 0; c <= cells; ++c) row[c] = low[c] + (low[c + cells + 1] - low[c]) * at[j].weight;
      float* out = &field[j * n];
      for (std::size_t i = 0; i < n; ++i) {
        const Place& place = at[i];
        out[i] += static_cast<float>(row[place.index] + (row[place.index + 1] - row[place.index]) * place.weight);
      }
    }
  }
  return field;
}

}  // namespace framesim
