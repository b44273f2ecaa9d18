#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "io/hdf5.hpp"
#include "io/hdf5_library.hpp"

namespace semigeo::io {
namespace {

constexpr std::int64_t kLargestChunk = 16 * 1024 * 1024;  // ours have 256 KiB
constexpr unsigned kHighestDeflateLevel = 9;

hid_t number_type(ElementType type) {
  switch (type) {
    case ElementType::float32:
      return H5T_IEEE_F32LE;
    case ElementType::float64:
      return H5T_IEEE_F64LE;
    case ElementType::int32:
      return H5T_STD_I32LE;
    case ElementType::int64:
      return H5T_STD_I64LE;
    case ElementType::uint8:
      return H5T_STD_U8LE;
    case ElementType::uint16:
      return H5T_STD_U16LE;
    default:
      break;  // a record
  }
  return H5I_INVALID_HID;
}

// Packed, in the order of the members.
Hdf5Handle record_type(std::span<const RecordMember> members, std::int64_t size) {
  Hdf5Handle record(H5Tcreate(H5T_COMPOUND, static_cast<std::size_t>(size)), H5Tclose);
  std::size_t offset = 0;
  for (const RecordMember& member : members) {
    const hid_t number = number_type(member.type);
    const auto columns = static_cast<hsize_t>(member.columns);
    const Hdf5Handle type(columns == 1 ? H5Tcopy(number) : H5Tarray_create2(number, 1, &columns),
                          H5Tclose);
    H5Tinsert(record.get(), member.name, offset, type.get());
    offset += H5Tget_size(type.get());
  }
  return record;
}

Hdf5Handle hdf5_type(ElementType type) {
  if (!members_of(type).empty()) return record_type(members_of(type), size_of(type));
  return {H5Tcopy(number_type(type)), H5Tclose};
}

std::optional<ElementType> element_type(hid_t type) {
  using enum ElementType;
  for (const ElementType known : {float32, float64, int32, int64, uint8, uint16})
    if (H5Tequal(type, number_type(known)) > 0) return known;
  if (H5Tget_class(type) != H5T_COMPOUND) return std::nullopt;
  for (const ElementType known : {feature, oriented_feature, posting})
    if (H5Tequal(type, hdf5_type(known).get()) > 0) return known;
  return std::nullopt;
}

// No volatile bytes: neither times nor whatever the fill value would be.
Hdf5Handle array_properties() {
  Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(properties.get(), false);
  H5Pset_fill_time(properties.get(), H5D_FILL_TIME_NEVER);
  return properties;
}

// The filters that Compression stands for, in order; nothing if they are others. Our decoder needs
// no parameters of theirs, but other readers do: shuffle's must be the size of an element.
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
  if (filters == std::vector<H5Z_filter_t>{H5Z_FILTER_FLETCHER32}) return Compression::none;
  if (filters ==
      std::vector<H5Z_filter_t>{H5Z_FILTER_SHUFFLE, H5Z_FILTER_DEFLATE, H5Z_FILTER_FLETCHER32})
    return Compression::deflate;
  return std::nullopt;
}

}  // namespace

void Hdf5File::write_array(const std::string& path, const EncodedArray& array) {
  if (static_cast<std::int64_t>(array.chunks.size()) != array.shape.chunk_count())
    throw std::invalid_argument(path + ": not every chunk was encoded");
  Growing growing = begin_array(path, array.shape);
  for (const EncodedChunk& chunk : array.chunks) growing.write_chunk(chunk);
  growing.close();
}

Hdf5File::Growing Hdf5File::begin_array(const std::string& path, const ArrayShape& shape) {
  const std::int64_t file = id();
  const Hdf5Handle properties = array_properties();
  // HDF5 has no chunks of a fixed extent of 0; an empty array is contiguous and holds no byte.
  if (shape.rows > 0) {
    const Extent chunk = extent(shape.chunk_rows, shape.columns);
    H5Pset_chunk(properties.get(), shape.columns == 1 ? 1 : 2, chunk.data());
    if (shape.compression == Compression::deflate) {
      H5Pset_shuffle(properties.get());
      H5Pset_deflate(properties.get(), 1);
    }
    H5Pset_fletcher32(properties.get());
  }
  const Hdf5Handle space = make_space(shape.rows, shape.columns);
  return {*this,
          path,
          shape,
          {checked(H5Dcreate2(file, path.c_str(), hdf5_type(shape.type).get(), space.get(),
                              H5P_DEFAULT, properties.get(), H5P_DEFAULT),
                   path, "create the dataset"),
           H5Dclose}};
}

void Hdf5File::Growing::write_chunk(const EncodedChunk& chunk) {
  prepare_library();
  if (written_ >= shape_.chunk_count())
    throw std::invalid_argument(path_ + ": more chunks than its shape has");
  const Extent offset = extent(written_++ * shape_.chunk_rows, 0);
  file_->checked(H5Dwrite_chunk(handle_.get(), H5P_DEFAULT, chunk.filter_mask, offset.data(),
                                chunk.bytes.size(), chunk.bytes.data()),
                 path_, "write a chunk");
}

void Hdf5File::Growing::close() {
  prepare_library();
  if (written_ != shape_.chunk_count())
    throw std::invalid_argument(path_ + ": not every chunk was written");
  file_->checked(handle_.close(), path_, "close the dataset");
}

void Hdf5File::write_virtual(const std::string& path, ElementType type, int columns,
                             std::span<const VirtualPiece> pieces) {
  const std::int64_t file = id();
  std::int64_t rows = 0;
  for (const VirtualPiece& piece : pieces) rows += piece.rows;
  const Hdf5Handle space = make_space(rows, columns);
  const Hdf5Handle properties = array_properties();
  std::int64_t first = 0;
  for (const VirtualPiece& piece : pieces) {
    const Extent start = extent(first, 0);
    const Extent count = extent(piece.rows, columns);
    const Hdf5Handle source(
        checked(H5Dopen2(file, piece.source.c_str(), H5P_DEFAULT), piece.source, "open the source"),
        H5Dclose);
    const Hdf5Handle source_space(H5Dget_space(source.get()), H5Sclose);
    checked(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(),
                                nullptr),
            path, "select rows");
    checked(H5Pset_virtual(properties.get(), space.get(), ".", piece.source.c_str(),
                           source_space.get()),
            path, "map a source");
    first += piece.rows;
  }
  H5Sselect_all(space.get());
  Hdf5Handle set(checked(H5Dcreate2(file, path.c_str(), hdf5_type(type).get(), space.get(),
                                    H5P_DEFAULT, properties.get(), H5P_DEFAULT),
                         path, "create the virtual dataset"),
                 H5Dclose);
  checked(set.close(), path, "close the virtual dataset");
}

Hdf5File::Array Hdf5File::open_array(const std::string& path) const {
  const std::int64_t file = id();
  Array array(
      *this, path,
      {checked(H5Dopen2(file, path.c_str(), H5P_DEFAULT), path, "open the dataset"), H5Dclose});
  arrays_.try_emplace(path, KnownArray{array.shape(), array.is_virtual()});
  return array;
}

const Hdf5File::KnownArray& Hdf5File::look_at(const std::string& path) const {
  if (!arrays_.contains(path)) open_array(path);
  return arrays_.at(path);
}

std::vector<std::byte> Hdf5File::read_through_library(const std::string& path) const {
  const Array array = open_array(path);
  std::vector<std::byte> bytes(
      static_cast<std::size_t>(array.shape_.rows * array.shape_.row_bytes()));
  checked(H5Dread(array.handle_.get(), hdf5_type(array.shape_.type).get(), H5S_ALL, H5S_ALL,
                  H5P_DEFAULT, bytes.data()),
          path, "read the dataset");
  return bytes;
}

Hdf5File::Array::Array(const Hdf5File& file, std::string path, Hdf5Handle handle)
    : file_(&file), path_(std::move(path)), handle_(std::move(handle)) {
  const Hdf5Handle type(H5Dget_type(handle_.get()), H5Tclose);
  const std::optional<ElementType> element = element_type(type.get());
  if (!element) file.refuse(path_, "its element type is none that a dataset uses");
  shape_.type = *element;

  const Hdf5Handle space(H5Dget_space(handle_.get()), H5Sclose);
  Extent size = {0, 1};
  const int rank = H5Sget_simple_extent_ndims(space.get());
  if (rank < 1 || rank > 2 ||
      H5Sget_simple_extent_dims(space.get(), size.data(), nullptr) != rank ||
      size[0] > (hsize_t{1} << 40) || (rank == 2 && (size[1] < 2 || size[1] > 1024)))
    file.refuse(path_, "its shape is none that a dataset uses");
  shape_.rows = static_cast<std::int64_t>(size[0]);
  shape_.columns = static_cast<int>(size[1]);

  const Hdf5Handle creation(H5Dget_create_plist(handle_.get()), H5Pclose);
  const H5D_layout_t layout = H5Pget_layout(creation.get());
  is_virtual_ = layout == H5D_VIRTUAL;
  if (is_virtual_ || (layout == H5D_CONTIGUOUS && shape_.rows == 0)) return;
  if (layout != H5D_CHUNKED) file.refuse(path_, "it is not stored in chunks");
  describe_chunks(creation.get());
}

void Hdf5File::Array::describe_chunks(std::int64_t creation) {
  Extent chunk = {0, 1};
  if (H5Pget_chunk(creation, 2, chunk.data()) < 1 ||
      chunk[1] != static_cast<hsize_t>(shape_.columns) || chunk[0] < 1)
    file_->refuse(path_, "its chunks are not whole rows");
  if (chunk[0] > static_cast<hsize_t>(kLargestChunk / shape_.row_bytes()))
    file_->refuse(path_, "its chunks are too large");
  shape_.chunk_rows = static_cast<std::int64_t>(chunk[0]);
  const std::optional<Compression> compression = compression_of(creation, shape_.type);
  if (!compression) file_->refuse(path_, "its filters are none that a dataset uses");
  shape_.compression = *compression;
}

bool Hdf5File::Array::has_attributes() const {
  return H5Aget_num_attrs(handle_.get()) != 0;
}

std::int64_t Hdf5File::Array::stored_bytes() const {
  return static_cast<std::int64_t>(H5Dget_storage_size(handle_.get()));
}

EncodedChunk Hdf5File::Array::read_chunk(std::int64_t index) const {
  prepare_library();
  const std::string place = path_ + ", chunk " + std::to_string(index);
  const Extent offset = extent(index * shape_.chunk_rows, 0);
  hsize_t size = 0;
  file_->checked(H5Dget_chunk_storage_size(handle_.get(), offset.data(), &size), place, "find it");
  if (size == 0) file_->refuse(place, "it is missing");
  if (size > 2 * static_cast<hsize_t>(shape_.chunk_bytes()) + 1024)
    file_->refuse(place, "it claims more bytes than a chunk can have");
  EncodedChunk chunk;
  chunk.bytes.resize(size);
  file_->checked(H5Dread_chunk(handle_.get(), H5P_DEFAULT, offset.data(), &chunk.filter_mask,
                               chunk.bytes.data()),
                 place, "read it");
  return chunk;
}

std::vector<VirtualPiece> Hdf5File::Array::virtual_pieces() const {
  prepare_library();
  const Hdf5Handle creation(H5Dget_create_plist(handle_.get()), H5Pclose);
  std::size_t count = 0;
  file_->checked(H5Pget_virtual_count(creation.get(), &count), path_, "list its sources");
  std::vector<VirtualPiece> pieces;
  std::int64_t first = 0;
  for (std::size_t i = 0; i < count; ++i) {
    std::array<char, 1024> file_name = {};
    std::array<char, 1024> source = {};
    Extent low = {0, 0};
    Extent high = {0, 0};
    const Hdf5Handle space(H5Pget_virtual_vspace(creation.get(), i), H5Sclose);
    if (H5Pget_virtual_filename(creation.get(), i, file_name.data(), file_name.size()) < 0 ||
        H5Pget_virtual_dsetname(creation.get(), i, source.data(), source.size()) < 0 ||
        H5Sget_select_bounds(space.get(), low.data(), high.data()) < 0)
      file_->fail(path_, "read its mapping");
    if (std::string_view(file_name.data()) != ".")
      file_->refuse(path_, "it shows data of another file");
    const auto rows = static_cast<std::int64_t>(high[0] - low[0] + 1);
    if (low != extent(first, 0) || H5Sget_select_npoints(space.get()) != rows * shape_.columns)
      file_->refuse(path_, "its sources do not follow one another");
    pieces.push_back({source.data(), rows});
    first += rows;
  }
  return pieces;
}

}  // namespace semigeo::io
