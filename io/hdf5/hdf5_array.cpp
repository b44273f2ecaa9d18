#include "io/hdf5/hdf5_array.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "io/hdf5/hdf5_library.hpp"

namespace semigeo::io {
namespace {

constexpr std::int64_t kLargestChunk = 16 * 1024 * 1024;  // semigeo writes chunks of 256 KiB
constexpr unsigned kHighestDeflateLevel = 9;

hid_t number_type(ElementType type) {
  switch (type) {
    case ElementType::kFloat32:
      return H5T_IEEE_F32LE;
    case ElementType::kFloat64:
      return H5T_IEEE_F64LE;
    case ElementType::kInt32:
      return H5T_STD_I32LE;
    case ElementType::kInt64:
      return H5T_STD_I64LE;
    case ElementType::kUint8:
      return H5T_STD_U8LE;
    case ElementType::kUint16:
      return H5T_STD_U16LE;
    default:
      break;  // a record
  }
  return H5I_INVALID_HID;
}

// Returns the HDF5 type of a record: packed, with the members in their order.
Hdf5Handle record_type(std::span<const RecordMember> members, std::int64_t size) {
  Hdf5Handle record(in_memory(H5Tcreate(H5T_COMPOUND, static_cast<std::size_t>(size))), H5Tclose);
  std::size_t offset = 0;
  for (const RecordMember& member : members) {
    const hid_t number = number_type(member.type);
    const auto columns = static_cast<hsize_t>(member.columns);
    const Hdf5Handle type(
        in_memory(columns == 1 ? H5Tcopy(number) : H5Tarray_create2(number, 1, &columns)),
        H5Tclose);
    in_memory(H5Tinsert(record.get(), member.name, offset, type.get()));
    offset += H5Tget_size(type.get());
  }
  return record;
}

// Arrays have no volatile bytes: they store no times and no fill values.
Hdf5Handle array_properties() {
  Hdf5Handle properties(in_memory(H5Pcreate(H5P_DATASET_CREATE)), H5Pclose);
  in_memory(H5Pset_obj_track_times(properties.get(), false));
  in_memory(H5Pset_fill_time(properties.get(), H5D_FILL_TIME_NEVER));
  return properties;
}

// Returns the Compression that the filters of an array stand for, or nothing if they are others.
// The decoder here needs no parameters of filters, but other readers do, so the parameter of
// shuffle must be the size of an element.
std::optional<Compression> compression_of(hid_t properties, ElementType type) {
  std::vector<H5Z_filter_t> filters;
  for (int i = 0; i < H5Pget_nfilters(properties); ++i) {
    unsigned flags = 0;
    unsigned config = 0;
    unsigned value = 0;
    std::size_t values = 1;
    const H5Z_filter_t filter = H5Pget_filter2(properties, static_cast<unsigned>(i), &flags,
                                               &values, &value, 0, nullptr, &config);
    if (filter == H5Z_FILTER_SHUFFLE && value != size_of(type)) return std::nullopt;
    if (filter == H5Z_FILTER_DEFLATE && value > kHighestDeflateLevel) return std::nullopt;
    filters.push_back(filter);
  }
  if (filters == std::vector<H5Z_filter_t>{H5Z_FILTER_FLETCHER32}) return Compression::kNone;
  if (filters ==
      std::vector<H5Z_filter_t>{H5Z_FILTER_SHUFFLE, H5Z_FILTER_DEFLATE, H5Z_FILTER_FLETCHER32})
    return Compression::kDeflate;
  return std::nullopt;
}

}  // namespace

std::int64_t Hdf5File::type_of(ElementType type) const {
  if (members_of(type).empty()) return number_type(type);
  const auto [record, is_new] = records_.try_emplace(type);
  if (is_new) record->second = record_type(members_of(type), size_of(type));
  return record->second.get();
}

std::optional<ElementType> Hdf5File::element_type(std::int64_t type) const {
  using enum ElementType;
  const bool record = H5Tget_class(type) == H5T_COMPOUND;
  for (const ElementType known : {kFloat32, kFloat64, kInt32, kInt64, kUint8, kUint16, kFeature,
                                  kContour, kOrientedFeature, kPosting})
    if (members_of(known).empty() != record && H5Tequal(type, type_of(known)) > 0) return known;
  return std::nullopt;
}

void Hdf5File::write_array(const std::string& path, const EncodedArray& array) {
  if (static_cast<std::int64_t>(array.chunks.size()) != array.shape.chunk_count())
    throw std::invalid_argument(path + ": not every chunk was encoded");
  Growing growing = begin_array(path, array.shape);
  for (const EncodedChunk& chunk : array.chunks) growing.write_chunk(chunk);
  growing.close();
}

Hdf5File::Growing Hdf5File::begin_array(const std::string& path, const ArrayShape& shape) {
  const Entry place = entry(path);
  const Hdf5Handle properties = array_properties();
  if (shape.compact) {
    in_memory(H5Pset_layout(properties.get(), H5D_COMPACT));
  } else if (shape.rows > 0) {  // HDF5 has no chunks of a fixed extent of 0
    const Extent chunk = extent(shape.chunk_rows, shape.columns);
    in_memory(H5Pset_chunk(properties.get(), shape.columns == 1 ? 1 : 2, chunk.data()));
    if (shape.compression == Compression::kDeflate) {
      in_memory(H5Pset_shuffle(properties.get()));
      in_memory(H5Pset_deflate(properties.get(), 1));
    }
    in_memory(H5Pset_fletcher32(properties.get()));
  }
  const Hdf5Handle space = make_space(shape.rows, shape.columns);
  Hdf5Handle set(checked(H5Dcreate2(place.group, place.name, type_of(shape.type), space.get(),
                                    H5P_DEFAULT, properties.get(), H5P_DEFAULT),
                         path, "create the dataset"),
                 H5Dclose);
  KnownArray& known = arrays_[path];
  known = {.shape = shape, .is_virtual = false, .pieces = {}, .rows = {}};
  return {*this, path, known, std::move(set)};
}

void Hdf5File::Growing::write_chunk(const EncodedChunk& chunk) {
  prepare_library();
  if (written_ >= shape().chunk_count())
    throw std::invalid_argument(path_ + ": more chunks than its shape has");
  const Extent offset = extent(written_++ * shape().chunk_rows, 0);
  if (shape().compact) {
    write_compact(chunk.bytes);
    return;
  }
  file_->checked(H5Dwrite_chunk(handle_.get(), H5P_DEFAULT, chunk.filter_mask, offset.data(),
                                chunk.bytes.size(), chunk.bytes.data()),
                 path_, "write a chunk");
}

void Hdf5File::Growing::write_compact(const std::vector<std::byte>& rows) {
  if (static_cast<std::int64_t>(rows.size()) != shape().rows * shape().row_bytes())
    throw std::invalid_argument(path_ + ": its rows have another size");
  file_->checked(H5Dwrite(handle_.get(), file_->type_of(shape().type), H5S_ALL, H5S_ALL,
                          H5P_DEFAULT, rows.data()),
                 path_, "write the dataset");
  known_->rows = rows;
}

void Hdf5File::Growing::close() {
  prepare_library();
  if (written_ != shape().chunk_count())
    throw std::invalid_argument(path_ + ": not every chunk was written");
  file_->checked(handle_.close(), path_, "close the dataset");
}

void Hdf5File::write_virtual(const std::string& path, ElementType type, int columns,
                             std::span<const VirtualPiece> pieces) {
  std::int64_t rows = 0;
  for (const VirtualPiece& piece : pieces) rows += piece.rows;
  const Hdf5Handle space = make_space(rows, columns);
  const Hdf5Handle properties = array_properties();
  std::int64_t first = 0;
  for (const VirtualPiece& piece : pieces) {
    const Extent start = extent(first, 0);
    const Extent count = extent(piece.rows, columns);
    const ArrayShape shape = shape_of(piece.source);
    const Hdf5Handle source_space = make_space(shape.rows, shape.columns);
    checked(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(),
                                nullptr),
            path, "select rows");
    checked(H5Pset_virtual(properties.get(), space.get(), ".", piece.source.c_str(),
                           source_space.get()),
            path, "map a source");
    first += piece.rows;
  }
  in_memory(H5Sselect_all(space.get()));
  const Entry place = entry(path);
  Hdf5Handle set(checked(H5Dcreate2(place.group, place.name, type_of(type), space.get(),
                                    H5P_DEFAULT, properties.get(), H5P_DEFAULT),
                         path, "create the virtual dataset"),
                 H5Dclose);
  checked(set.close(), path, "close the virtual dataset");
}

std::int64_t Hdf5File::Array::opened() const {
  prepare_library();
  if (handle_.get() < 0) {
    const Entry place = file_->entry(path_);
    handle_ = Hdf5Handle(
        file_->checked(H5Dopen2(place.group, place.name, H5P_DEFAULT), path_, "open the dataset"),
        H5Dclose);
  }
  return handle_.get();
}

Hdf5File::Array Hdf5File::open_array(const std::string& path) const {
  Array array(*this, path);
  auto known = arrays_.find(path);
  if (known == arrays_.end()) known = arrays_.emplace(path, described(path, array.opened())).first;
  array.known_ = &known->second;
  return array;
}

const Hdf5File::KnownArray& Hdf5File::look_at(const std::string& path) const {
  return *open_array(path).known_;
}

std::vector<std::byte> Hdf5File::read_through_library(const std::string& path) const {
  const Array array = open_array(path);
  std::vector<std::byte> bytes(
      static_cast<std::size_t>(array.shape().rows * array.shape().row_bytes()));
  checked(H5Dread(array.opened(), type_of(array.shape().type), H5S_ALL, H5S_ALL, H5P_DEFAULT,
                  bytes.data()),
          path, "read the dataset");
  return bytes;
}

Hdf5File::KnownArray Hdf5File::described(const std::string& path, std::int64_t array) const {
  KnownArray known;
  ArrayShape& shape = known.shape;
  const Hdf5Handle type(checked(H5Dget_type(array), path, "read its type"), H5Tclose);
  const std::optional<ElementType> element = element_type(type.get());
  if (!element) refuse(path, "its element type is none that a dataset uses");
  shape.type = *element;

  const Hdf5Handle space(checked(H5Dget_space(array), path, "read its shape"), H5Sclose);
  Extent size = {0, 1};
  const int rank = H5Sget_simple_extent_ndims(space.get());
  if (rank < 1 || rank > 2 ||
      H5Sget_simple_extent_dims(space.get(), size.data(), nullptr) != rank ||
      size[0] > (hsize_t{1} << 40) || (rank == 2 && (size[1] < 2 || size[1] > 1024)))
    refuse(path, "its shape is none that a dataset uses");
  shape.rows = static_cast<std::int64_t>(size[0]);
  shape.columns = static_cast<int>(size[1]);

  const Hdf5Handle creation(checked(H5Dget_create_plist(array), path, "read its properties"),
                            H5Pclose);
  const auto layout =
      static_cast<H5D_layout_t>(checked(H5Pget_layout(creation.get()), path, "read its layout"));
  known.is_virtual = layout == H5D_VIRTUAL;
  if (known.is_virtual) {
    known.pieces = pieces_of(path, creation.get(), shape.columns);
  } else if (layout == H5D_COMPACT) {
    known.rows = compact_rows(path, array, shape);
    shape.compact = true;
    shape.chunk_rows = shape.rows;
  } else if (layout == H5D_CHUNKED) {
    describe_chunks(path, creation.get(), shape);
  } else if (shape.rows > 0) {
    refuse(path, "it is stored neither in chunks nor in its header");
  }
  return known;
}

void Hdf5File::describe_chunks(const std::string& path, std::int64_t creation,
                               ArrayShape& shape) const {
  Extent chunk = {0, 1};
  if (H5Pget_chunk(creation, 2, chunk.data()) < 1 ||
      chunk[1] != static_cast<hsize_t>(shape.columns) || chunk[0] < 1)
    refuse(path, "its chunks are not whole rows");
  if (chunk[0] > static_cast<hsize_t>(kLargestChunk / shape.row_bytes()))
    refuse(path, "its chunks are too large");
  shape.chunk_rows = static_cast<std::int64_t>(chunk[0]);
  const std::optional<Compression> compression = compression_of(creation, shape.type);
  if (!compression) refuse(path, "its filters are none that a dataset uses");
  shape.compression = *compression;
}

std::vector<std::byte> Hdf5File::compact_rows(const std::string& path, std::int64_t array,
                                              const ArrayShape& shape) const {
  const std::int64_t bytes = shape.rows * shape.row_bytes();
  if (shape.rows < 1 || bytes > kMostCompactBytes)
    refuse(path, "it has another size than what is stored in a header");
  std::vector<std::byte> rows(static_cast<std::size_t>(bytes));
  checked(H5Dread(array, type_of(shape.type), H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()), path,
          "read the dataset");
  return rows;
}

std::vector<VirtualPiece> Hdf5File::pieces_of(const std::string& path, std::int64_t creation,
                                              int columns) const {
  std::size_t count = 0;
  checked(H5Pget_virtual_count(creation, &count), path, "list its sources");
  std::vector<VirtualPiece> pieces;
  std::int64_t first = 0;
  for (std::size_t i = 0; i < count; ++i) {
    std::array<char, 1024> file_name = {};
    std::array<char, 1024> source = {};
    Extent low = {0, 0};
    Extent high = {0, 0};
    const Hdf5Handle space(checked(H5Pget_virtual_vspace(creation, i), path, "read its mapping"),
                           H5Sclose);
    if (H5Pget_virtual_filename(creation, i, file_name.data(), file_name.size()) < 0 ||
        H5Pget_virtual_dsetname(creation, i, source.data(), source.size()) < 0 ||
        H5Sget_select_bounds(space.get(), low.data(), high.data()) < 0)
      fail(path, "read its mapping");
    if (std::string_view(file_name.data()) != ".") refuse(path, "it shows data of another file");
    const auto rows = static_cast<std::int64_t>(high[0] - low[0] + 1);
    if (low != extent(first, 0) || H5Sget_select_npoints(space.get()) != rows * columns)
      refuse(path, "its sources do not follow one another");
    pieces.push_back({source.data(), rows});
    first += rows;
  }
  return pieces;
}

bool Hdf5File::Array::has_attributes() const {
  return H5Aget_num_attrs(opened()) != 0;
}

std::int64_t Hdf5File::Array::stored_bytes() const {
  if (shape().compact) return static_cast<std::int64_t>(known_->rows.size());
  const hsize_t size = H5Dget_storage_size(opened());
  // 0 is also what it returns if it fails.
  if (size == 0 && H5Eget_num(H5E_DEFAULT) > 0) file_->fail(path_, "find its chunks");
  return static_cast<std::int64_t>(size);
}

EncodedChunk Hdf5File::Array::read_chunk(std::int64_t index) const {
  EncodedChunk chunk;
  if (shape().compact) {
    chunk.bytes = known_->rows;
    return chunk;
  }
  const std::int64_t array = opened();
  const std::string place = path_ + ", chunk " + std::to_string(index);
  const Extent offset = extent(index * shape().chunk_rows, 0);
  hsize_t size = 0;
  file_->checked(H5Dget_chunk_storage_size(array, offset.data(), &size), place, "find it");
  if (size == 0) file_->refuse(place, "it is missing");
  if (size > 2 * static_cast<hsize_t>(shape().chunk_bytes()) + 1024)
    file_->refuse(place, "it claims more bytes than a chunk can have");
  chunk.bytes.resize(size);
  file_->checked(
      H5Dread_chunk(array, H5P_DEFAULT, offset.data(), &chunk.filter_mask, chunk.bytes.data()),
      place, "read it");
  return chunk;
}

}  // namespace semigeo::io
