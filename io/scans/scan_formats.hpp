#pragma once

#include "io/files/byte_source.hpp"
#include "io/scans/scan_reader.hpp"

namespace semigeo::io {

// One reader per format, for read_scan. Each takes a source at its start that holds at least one
// byte, and leaves it anywhere.
Scan read_ply(ByteSource& source, const ScanLimits& limits);
Scan read_obj(ByteSource& source, const ScanLimits& limits);
Scan read_off(ByteSource& source, const ScanLimits& limits);
Scan read_stl(ByteSource& source, const ScanLimits& limits);

}  // namespace semigeo::io
