#include "engine/resources.hpp"

#include <stdexcept>

namespace semigeo::engine {

bool Resources::fits(Amount wanted) const {
  // Differences are compared, because sums may overflow.
  return in_use_.cores <= total_.cores && wanted.cores <= total_.cores - in_use_.cores &&
         in_use_.bytes <= total_.bytes && wanted.bytes <= total_.bytes - in_use_.bytes;
}

bool Resources::admit(Amount wanted) {
  if (wanted.cores < 0) throw std::invalid_argument("a job with a negative number of cores");
  if (running_ > 0 && !fits(wanted)) return false;
  in_use_.cores += wanted.cores;
  in_use_.bytes += wanted.bytes;
  ++running_;
  return true;
}

void Resources::release(Amount wanted) {
  if (running_ == 0 || wanted.cores < 0 || wanted.cores > in_use_.cores ||
      wanted.bytes > in_use_.bytes)
    throw std::logic_error("more resources released than are in use");
  in_use_.cores -= wanted.cores;
  in_use_.bytes -= wanted.bytes;
  --running_;
}

}  // namespace semigeo::engine
