#include <algorithm>
#include <string_view>

#include "io/files/error.hpp"
#include "io/files/utf8.hpp"
#include "io/hdf5/hdf5.hpp"
#include "io/hdf5/hdf5_library.hpp"

namespace semigeo::io {
namespace {

constexpr std::int64_t kLargestAttribute =
    60 * 1024;  // a message in an object header has less than 64 KiB

bool is_ascii(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](unsigned char c) { return c < 0x80; });
}

std::string counted(std::string type, std::size_t count) {
  return type.append("[").append(std::to_string(count)).append("]");
}

Hdf5Handle string_type(std::string_view text) {
  Hdf5Handle type(in_memory(H5Tcopy(H5T_C_S1)), H5Tclose);
  in_memory(H5Tset_size(type.get(), std::max<std::size_t>(text.size(), 1)));
  in_memory(H5Tset_strpad(type.get(), H5T_STR_NULLPAD));
  in_memory(H5Tset_cset(type.get(), is_ascii(text) ? H5T_CSET_ASCII : H5T_CSET_UTF8));
  return type;
}

struct AttributeShape {
  enum class Kind { kInteger, kReal, kText, kUnsupported };
  Kind kind = Kind::kUnsupported;
  bool scalar = true;
  std::int64_t count = 1;  // number of elements, or of bytes of the text
  bool ascii = true;
};

AttributeShape attribute_shape(hid_t attribute) {
  const Hdf5Handle type(H5Aget_type(attribute), H5Tclose);
  const Hdf5Handle space(H5Aget_space(attribute), H5Sclose);
  AttributeShape shape;
  if (type.get() < 0 || space.get() < 0) return shape;  // no memory, or damage
  const int rank = H5Sget_simple_extent_ndims(space.get());
  shape.scalar = rank == 0;
  shape.count = H5Sget_simple_extent_npoints(space.get());
  if (rank < 0 || rank > 1 || shape.count > kLargestAttribute / 8) return shape;
  if (H5Tequal(type.get(), H5T_STD_I64LE) > 0) shape.kind = AttributeShape::Kind::kInteger;
  if (H5Tequal(type.get(), H5T_IEEE_F64LE) > 0) shape.kind = AttributeShape::Kind::kReal;
  if (H5Tget_class(type.get()) == H5T_STRING && H5Tis_variable_str(type.get()) == 0 &&
      shape.scalar) {
    shape.kind = AttributeShape::Kind::kText;
    shape.count = static_cast<std::int64_t>(H5Tget_size(type.get()));
    shape.ascii = H5Tget_cset(type.get()) == H5T_CSET_ASCII;
  }
  return shape;
}

/// Returns the type as io::attribute_type names it, or "unsupported".
std::string text_of(const AttributeShape& shape) {
  const auto count = static_cast<std::size_t>(shape.count);
  switch (shape.kind) {
    case AttributeShape::Kind::kInteger:
      return shape.scalar ? "int64" : counted("int64", count);
    case AttributeShape::Kind::kReal:
      return shape.scalar ? "float64" : counted("float64", count);
    case AttributeShape::Kind::kText:
      return counted(shape.ascii ? "ascii" : "utf8", count);
    case AttributeShape::Kind::kUnsupported:
      break;
  }
  return "unsupported";
}

herr_t collect_name(hid_t, const char* name, const H5A_info_t*, void* data) noexcept {
  try {
    static_cast<std::vector<std::string>*>(data)->emplace_back(name);
    return 0;
  } catch (...) {
    return -1;
  }
}

}  // namespace

std::string attribute_type(const AttributeValue& value) {
  if (const auto* text = std::get_if<std::string>(&value))
    return counted(is_ascii(*text) ? "ascii" : "utf8", std::max<std::size_t>(text->size(), 1));
  if (const auto* integers = std::get_if<std::vector<std::int64_t>>(&value))
    return counted("int64", integers->size());
  if (const auto* reals = std::get_if<std::vector<double>>(&value))
    return counted("float64", reals->size());
  return std::holds_alternative<double>(value) ? "float64" : "int64";
}

void Hdf5File::write_attribute(const std::string& object, const std::string& name,
                               const AttributeValue& value) {
  const std::int64_t owner = opened(object);
  attributes_.erase(object);
  const auto write = [&](hid_t type, hid_t space, const void* data, std::size_t bytes) {
    const std::string place = object + ", attribute " + name;
    if (bytes > kLargestAttribute)
      throw Error(shown_as_, place, "has " + std::to_string(bytes) + " bytes, more than HDF5 holds",
                  "at most " + std::to_string(kLargestAttribute) + " are possible");
    Hdf5Handle attribute(
        checked(H5Acreate2(owner, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), place,
                "create the attribute"),
        H5Aclose);
    checked(H5Awrite(attribute.get(), type, data), place, "write the attribute");
    checked(attribute.close(), place, "close the attribute");
  };
  const Hdf5Handle scalar(in_memory(H5Screate(H5S_SCALAR)), H5Sclose);
  if (const auto* text = std::get_if<std::string>(&value)) {
    write(string_type(*text).get(), scalar.get(), text->c_str(), text->size());
  } else if (const auto* integer = std::get_if<std::int64_t>(&value)) {
    write(H5T_STD_I64LE, scalar.get(), integer, sizeof *integer);
  } else if (const auto* real = std::get_if<double>(&value)) {
    write(H5T_IEEE_F64LE, scalar.get(), real, sizeof *real);
  } else if (const auto* integers = std::get_if<std::vector<std::int64_t>>(&value)) {
    const Hdf5Handle space = make_space(static_cast<std::int64_t>(integers->size()), 1);
    write(H5T_STD_I64LE, space.get(), integers->data(), integers->size() * 8);
  } else if (const auto* reals = std::get_if<std::vector<double>>(&value)) {
    const Hdf5Handle space = make_space(static_cast<std::int64_t>(reals->size()), 1);
    write(H5T_IEEE_F64LE, space.get(), reals->data(), reals->size() * 8);
  }
}

Hdf5Handle Hdf5File::open_attribute(const std::string& object, const std::string& name) const {
  return {checked(H5Aopen(opened(object), name.c_str(), H5P_DEFAULT),
                  object + ", attribute " + name, "open the attribute"),
          H5Aclose};
}

const Hdf5Attribute* Hdf5File::find_known(const std::string& object,
                                          const std::string& name) const {
  const auto known = attributes_.find(object);
  if (known == attributes_.end()) return nullptr;
  const auto found = std::ranges::lower_bound(known->second, name, {}, &Hdf5Attribute::name);
  return found == known->second.end() || found->name != name ? nullptr : &*found;
}

bool Hdf5File::has_attribute(const std::string& object, const std::string& name) const {
  if (find_known(object, name) != nullptr) return true;
  return checked(H5Aexists(opened(object), name.c_str()), object + ", attribute " + name,
                 "look for the attribute") > 0;
}

AttributeValue Hdf5File::read_attribute(const std::string& object, const std::string& name) const {
  if (const Hdf5Attribute* known = find_known(object, name)) return known->value;
  return read(open_attribute(object, name), object, name).value;
}

Hdf5Attribute Hdf5File::read(const Hdf5Handle& attribute, const std::string& object,
                             const std::string& name) const {
  const std::string place = object + ", attribute " + name;
  const AttributeShape shape = attribute_shape(attribute.get());
  const auto read = [&](hid_t type, void* data) {
    checked(H5Aread(attribute.get(), type, data), place, "read the attribute");
  };
  const auto numbers = [&]<typename Number>(hid_t type, Number) -> AttributeValue {
    std::vector<Number> values(static_cast<std::size_t>(shape.count));
    read(type, values.data());
    return shape.scalar ? AttributeValue(values.front()) : AttributeValue(values);
  };
  Hdf5Attribute result{name, text_of(shape), {}};
  switch (shape.kind) {
    case AttributeShape::Kind::kInteger:
      result.value = numbers(H5T_STD_I64LE, std::int64_t{});
      return result;
    case AttributeShape::Kind::kReal:
      result.value = numbers(H5T_IEEE_F64LE, double{});
      return result;
    case AttributeShape::Kind::kText: {
      if (shape.count > kLargestAttribute) break;
      std::string text(static_cast<std::size_t>(shape.count), '\0');
      const Hdf5Handle type(checked(H5Aget_type(attribute.get()), place, "read its type"),
                            H5Tclose);
      read(type.get(), text.data());
      if (!is_utf8(text)) refuse(place, "is no UTF-8 text");
      if (text != std::string(1, '\0'))
        result.value = text;  // HDF5 has no size of 0
      else
        result.value = std::string();
      return result;
    }
    case AttributeShape::Kind::kUnsupported:
      break;
  }
  refuse(place, "its type is none that a dataset uses");
}

std::string Hdf5File::attribute_type(const std::string& object, const std::string& name) const {
  if (const Hdf5Attribute* known = find_known(object, name)) return known->type;
  return text_of(attribute_shape(open_attribute(object, name).get()));
}

const std::vector<Hdf5Attribute>& Hdf5File::attributes(const std::string& object) const {
  const auto known = attributes_.find(object);
  if (known != attributes_.end()) return known->second;
  std::vector<std::string> names;
  checked(H5Aiterate2(opened(object), H5_INDEX_NAME, H5_ITER_INC, nullptr, collect_name, &names),
          object, "list the attributes");
  std::ranges::sort(names);
  std::vector<Hdf5Attribute> found;
  found.reserve(names.size());
  for (const std::string& name : names)
    found.push_back(read(open_attribute(object, name), object, name));
  return attributes_.emplace(object, std::move(found)).first->second;
}

}  // namespace semigeo::io
