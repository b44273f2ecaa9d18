#include <cmath>
#include <cstring>
#include <numeric>

#include "io/dataset/vtkhdf.hpp"
#include "io/hdf5/array_reader.hpp"

namespace semigeo::io {
namespace {

constexpr int kCategories = 4;
constexpr int kPolygons = 2;
constexpr std::array<const char*, kCategories> kCategoryNames = {"Vertices", "Lines", "Polygons",
                                                                 "Strips"};

constexpr std::int64_t kLargest = std::int64_t{1} << 40;

using Numbers = std::vector<std::int64_t>;

class Check {
 public:
  explicit Check(const Hdf5File& file) : file_(file) {}

  void run() {
    header();
    steps();
    parts();
    points();
    for (const std::string category : kCategoryNames)
      category == "Polygons" ? polygons() : empty_category(category);
  }

 private:
  [[noreturn]] void breaks(const std::string& path, const std::string& rule) const {
    file_.refuse("/VTKHDF" + (path.empty() ? path : "/" + path), rule);
  }

  void require(bool holds, const std::string& path, const std::string& rule) const {
    if (!holds) breaks(path, rule);
  }

  Numbers numbers(const std::string& path, int columns = 1) const {
    require(file_.has("/VTKHDF/" + path), path, "VTKHDF needs it, but it is missing");
    Numbers values = read_integers(file_, "/VTKHDF/" + path, columns);
    for (const std::int64_t value : values)  // then no sum can overflow
      require(value >= 0 && value <= kLargest, path, "has a value that no count can have");
    return values;
  }

  // Returns the value of an attribute, which must have exactly this type.
  template <typename Value>
  Value attribute(const std::string& object, const std::string& name, const std::string& type) {
    const std::string path = "/VTKHDF" + (object.empty() ? object : "/" + object);
    if (!file_.has(path) || !file_.has_attribute(path, name))
      breaks(object, "VTKHDF needs its attribute " + name + ", but it is missing");
    const std::string found = file_.attribute_type(path, name);
    require(found == type, object, "its attribute " + name + " must be " + type + ", not " + found);
    return std::get<Value>(file_.read_attribute(path, name));
  }

  void header() {
    require(attribute<std::string>("", "Type", "ascii[8]") == "PolyData", "",
            "its attribute Type must be PolyData");
    require(attribute<Numbers>("", "Version", "int64[2]") == Numbers{2, 0}, "",
            "its attribute Version must be 2, 0");
  }

  void steps() {
    const auto count = attribute<std::int64_t>("Steps", "NSteps", "int64");
    require(count >= 1, "Steps", "its attribute NSteps must be at least 1");
    require(file_.has("/VTKHDF/Steps/Values"), "Steps/Values",
            "VTKHDF needs it, but it is missing");
    const std::vector<double> values = read_doubles(file_, "/VTKHDF/Steps/Values", 1);
    require(static_cast<std::int64_t>(values.size()) == count, "Steps/Values",
            "must have one value per step");
    for (std::size_t k = 0; k < values.size(); ++k)
      require(std::isfinite(values[k]) && (k == 0 || values[k] > values[k - 1]), "Steps/Values",
              "must be strictly increasing");
    steps_ = values.size();
    require(numbers("Steps/NumberOfParts") == Numbers(steps_, 1), "Steps/NumberOfParts",
            "must be 1 in every step");
  }

  void parts() {
    vertices_ = numbers("NumberOfPoints");
    require(vertices_.size() == steps_ || vertices_.size() == 1, "NumberOfPoints",
            "must have one entry, or one per step if the connectivity changes");
    changes_ = vertices_.size() > 1;
    Numbers expected(steps_, 0);
    if (changes_) std::iota(expected.begin(), expected.end(), 0);
    require(numbers("Steps/PartOffsets") == expected, "Steps/PartOffsets",
            changes_ ? "must count the steps, as the connectivity changes"
                     : "must be 0, as all steps have the same connectivity");
  }

  // Returns the first element of each step, if the elements of all steps follow one another. `sum`
  // gets their number.
  Numbers starts(const Numbers& counts, std::int64_t& sum) const {
    Numbers result;
    sum = 0;
    for (std::size_t k = 0; k < steps_; ++k) {
      result.push_back(sum);
      sum += counts[changes_ ? k : 0];
    }
    return result;
  }

  void points() {
    std::int64_t sum = 0;
    const Numbers expected = starts(vertices_, sum);
    require(numbers("Steps/PointOffsets") == expected, "Steps/PointOffsets",
            "must be the sums of the points of the steps before");
    view("Points", ElementType::kFloat32, 3, sum);
    std::vector<std::string> names;
    require(file_.has("/VTKHDF/PointData"), "PointData", "VTKHDF needs it, but it is missing");
    for (const Hdf5Link& link : file_.links("/VTKHDF/PointData")) {
      const std::string path = "PointData/" + link.name;
      require(link.name.find('.') == std::string::npos, path, "its name must not have a '.'");
      require(link.kind == Hdf5Link::Kind::kArray, path, "must be a dataset");
      const ArrayShape shape = file_.open_array("/VTKHDF/" + path).shape();
      view(path, shape.type, shape.columns, sum);
      require(numbers("Steps/PointDataOffsets/" + link.name) == expected,
              "Steps/PointDataOffsets/" + link.name,
              "must be the sums of the points of the steps before");
    }
  }

  // Checks a virtual dataset: it has this shape and shows whole datasets of its element type.
  void view(const std::string& path, ElementType type, int columns, std::int64_t rows) const {
    require(file_.has("/VTKHDF/" + path), path, "VTKHDF needs it, but it is missing");
    const Hdf5File::Array array = file_.open_array("/VTKHDF/" + path);
    const ArrayShape& shape = array.shape();
    require(array.is_virtual(), path, "must be virtual, so that no byte is stored twice");
    require(shape.type == type && shape.columns == columns, path, "has the wrong type or columns");
    require(shape.rows == rows, path,
            "has " + std::to_string(shape.rows) + " rows, but its offsets add up to " +
                std::to_string(rows));
    std::int64_t shown = 0;
    for (const VirtualPiece& piece : array.virtual_pieces()) {
      require(file_.has(piece.source), path, "shows " + piece.source + ", which does not exist");
      const ArrayShape from = file_.shape_of(piece.source);
      require(!file_.is_virtual(piece.source) && from.type == type &&
                  from.rows * from.columns == piece.rows * columns,
              path, "shows " + piece.source + ", which has another type or size");
      shown += piece.rows;
    }
    require(shown == rows, path, "its sources do not fill it");
  }

  // Checks a table that has one row for each step. Its column `category` must be `expected`.
  void step_column(const std::string& path, int category, const Numbers& expected) const {
    const Numbers table = numbers(path, kCategories);
    require(table.size() == steps_ * kCategories, path, "must have one row per step");
    for (std::size_t k = 0; k < steps_; ++k)
      require(table[k * kCategories + category] == expected[k], path,
              std::string("its column ") + kCategoryNames[category] +
                  " must be the sums of the steps before");
  }

  void empty_category(const std::string& name) const {
    const Numbers none(vertices_.size(), 0);
    for (const char* table : {"/NumberOfCells", "/NumberOfConnectivityIds", "/Offsets"})
      require(numbers(name + table) == none, name + table,
              "must be one 0 for each part: it has no cells");
    require(numbers(name + "/Connectivity").empty(), name + "/Connectivity",
            "must be empty: it has no cells");
    const int category = name == "Vertices" ? 0 : name == "Lines" ? 1 : 3;
    step_column("Steps/CellOffsets", category, Numbers(steps_, 0));
    step_column("Steps/ConnectivityIdOffsets", category, Numbers(steps_, 0));
  }

  void polygons() const {
    const Numbers cells = numbers("Polygons/NumberOfCells");
    const Numbers corners = numbers("Polygons/NumberOfConnectivityIds");
    require(cells.size() == vertices_.size(), "Polygons/NumberOfCells",
            "must have one entry for each part");
    require(corners.size() == vertices_.size(), "Polygons/NumberOfConnectivityIds",
            "must have one entry for each part");
    std::int64_t all_corners = 0;
    for (std::size_t p = 0; p < cells.size(); ++p) {
      require(cells[p] >= 0 && corners[p] == 3 * cells[p], "Polygons/NumberOfConnectivityIds",
              "must be three for each cell");
      all_corners += corners[p];
    }
    std::int64_t unused = 0;
    const Numbers none(steps_, 0);
    step_column("Steps/CellOffsets", kPolygons, changes_ ? starts(cells, unused) : none);
    step_column("Steps/ConnectivityIdOffsets", kPolygons,
                changes_ ? starts(corners, unused) : none);
    view("Polygons/Connectivity", ElementType::kInt64, 1, all_corners);
    polygon_offsets(cells);
  }

  void polygon_offsets(const Numbers& cells) const {
    const std::string path = "Polygons/Offsets";
    require(file_.has("/VTKHDF/" + path), path, "VTKHDF needs it, but it is missing");
    const Hdf5File::Array array = file_.open_array("/VTKHDF/" + path);
    const std::int64_t rows = std::accumulate(cells.begin(), cells.end(), std::int64_t{0}) +
                              static_cast<std::int64_t>(cells.size());
    require(!array.is_virtual() && array.shape().type == ElementType::kInt64 &&
                array.shape().columns == 1 && array.shape().rows == rows,
            path, "must be int64, one more than cells for each part");
    std::size_t part = 0;
    std::int64_t within = 0;
    for_each_chunk(array, [&](std::span<const std::byte> bytes) {
      for (std::size_t at = 0; at < bytes.size(); at += sizeof(std::int64_t)) {
        std::int64_t value = 0;
        std::memcpy(&value, bytes.data() + at, sizeof value);
        require(value == 3 * within, path, "must rise by 3, from 0 again in each part");
        if (++within > cells[part]) {
          ++part;
          within = 0;
        }
      }
    });
  }

  const Hdf5File& file_;
  std::size_t steps_ = 0;
  Numbers vertices_;  // number of vertices of each part
  bool changes_ = false;
};

}  // namespace

void check_vtkhdf(const Hdf5File& file) {
  if (!file.has("/VTKHDF")) file.refuse("/VTKHDF", "it is missing");
  Check(file).run();
}

}  // namespace semigeo::io
