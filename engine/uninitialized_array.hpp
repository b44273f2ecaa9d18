#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>

namespace semigeo::engine {

/// Holds an array for values that threads will fill. Unlike a vector, it does not write them first:
/// that would be serial, and most of its time would go into the first touch of each page.
template <typename Value>
class UninitializedArray {
  static_assert(std::is_trivially_destructible_v<Value>);

 public:
  UninitializedArray() = default;
  UninitializedArray(const UninitializedArray& other) {
    resize(other.size());
    std::copy(other.begin(), other.end(), begin());
  }
  UninitializedArray(UninitializedArray&&) noexcept = default;
  UninitializedArray& operator=(UninitializedArray other) {
    values_ = std::move(other.values_);
    size_ = other.size_;
    capacity_ = other.capacity_;
    return *this;
  }
  ~UninitializedArray() = default;

  /// Gives the array a size. The values are undefined, also those that it had. Memory is allocated
  /// only if the array has never been so large. Throws std::bad_alloc.
  void resize(std::size_t size) {
    if (size > capacity_) {
      values_.reset();
      capacity_ = 0;
      values_ = std::make_unique_for_overwrite<Value[]>(size);
      capacity_ = size;
    }
    size_ = size;
  }
  std::size_t size() const { return size_; }
  Value* begin() { return values_.get(); }
  Value* end() { return values_.get() + size_; }
  const Value* begin() const { return values_.get(); }
  const Value* end() const { return values_.get() + size_; }
  Value& operator[](std::size_t i) { return values_[i]; }
  const Value& operator[](std::size_t i) const { return values_[i]; }

 private:
  std::unique_ptr<Value[]> values_;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

}  // namespace semigeo::engine
