// rows: instances in straight rows, as seats in an auditorium or lamps along a corridor. Nothing is random. O(count).
#include "scenes/generator.h"
#include "scenes/generators/place.h"

namespace framesim {
namespace {

struct RowsParameters {
  std::int64_t columns = 1, rows = 1;
  double x = 0, y = 0, z = 0;
  double step_x = 1, step_z = 1;
  double rise = 0;
  double scale = 1;
};

constexpr double kFar = 1e6;  // metres

const ParameterTable<RowsParameters>& parameters() {
  static const ParameterTable<RowsParameters> table{{
      {"columns", &RowsParameters::columns, {.low = 1, .high = kMostCount, .help = "instances in a row, along x"}},
      {"rows", &RowsParameters::rows, {.low = 1, .high = kMostCount, .help = "rows, along z"}},
      {"x", &RowsParameters::x, {.unit = "m", .low = -kFar, .high = kFar, .help = "centre of the first instance"}},
      {"y", &RowsParameters::y, {.unit = "m", .low = -kFar, .high = kFar, .help = "centre of the first instance"}},
      {"z", &RowsParameters::z, {.unit = "m", .low = -kFar, .high = kFar, .help = "centre of the first instance"}},
      {"step_x",
       &RowsParameters::step_x,
       {.unit = "m", .low = -kFar, .high = kFar, .help = "from one to the next in a row"}},
      {"step_z", &RowsParameters::step_z, {.unit = "m", .low = -kFar, .high = kFar, .help = "from row to row"}},
      {"rise", &RowsParameters::rise, {.unit = "m", .low = -kFar, .high = kFar, .help = "height from row to row"}},
      {"scale", &RowsParameters::scale, {.low = 1e-3, .high = 1e3, .help = "scale of all"}},
  }};
  return table;
}

class Rows final : public Generator {
 public:
  Rows(const RowsParameters& p, std::string type, std::string cell)
      : p_(p), type_(std::move(type)), cell_(std::move(cell)) {}

  void generate(Scene& scene, const InputLocation& where) const override {
    const TypeId type = find_type(scene, type_, where);
    const std::uint16_t cell = find_cell(scene, cell_, where);
    reserve_instances(scene, count_of(static_cast<double>(p_.columns) * static_cast<double>(p_.rows)), where);
    for (std::int64_t row = 0; row < p_.rows; ++row) {
      for (std::int64_t column = 0; column < p_.columns; ++column) {
        const auto r = static_cast<double>(row), c = static_cast<double>(column);
        place_instance(scene, type, {p_.x + c * p_.step_x, p_.y + r * p_.rise, p_.z + r * p_.step_z}, p_.scale, cell);
      }
    }
  }

 private:
  const RowsParameters p_;
  const std::string type_, cell_;
};

std::unique_ptr<Generator> make(const Settings& given) {
  Settings settings = given;
  std::string type = take_text(settings, "type", "");
  std::string cell = take_text(settings, "cell", "");
  return std::make_unique<Rows>(parameters().read(settings), std::move(type), std::move(cell));
}

}  // namespace

GeneratorEntry rows_generator() {
  std::vector<ParameterInfo> infos = parameters().describe();
  infos.push_back(text_parameter("type", "", "a type's name", "what stands in the rows"));
  infos.push_back(text_parameter("cell", "", "a cell's name", "cell that the instances stand in"));
  return {.name = "rows", .summary = "instances in straight rows, level or rising", .parameters = infos, .make = make};
}

}  // namespace framesim
