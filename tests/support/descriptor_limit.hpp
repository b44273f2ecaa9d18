#pragma once

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

namespace semigeo::tests {

/// While it lives, this process can open no more than `more` files (EMFILE).
class DescriptorLimit {
 public:
  explicit DescriptorLimit(int more = 0) {
    getrlimit(RLIMIT_NOFILE, &before_);
    const int next = open("/dev/null", O_RDONLY | O_CLOEXEC);  // the lowest that is free
    const rlimit limit{static_cast<rlim_t>(next + more), before_.rlim_max};
    close(next);
    setrlimit(RLIMIT_NOFILE, &limit);
  }
  ~DescriptorLimit() { setrlimit(RLIMIT_NOFILE, &before_); }
  DescriptorLimit(const DescriptorLimit&) = delete;
  DescriptorLimit& operator=(const DescriptorLimit&) = delete;

 private:
  rlimit before_{};
};

}  // namespace semigeo::tests
