#pragma once

#include <filesystem>

namespace semigeo::jobs {

/// Throws io::Error if one of the folders in which runs write and remove files is a symbolic link:
/// whoever may write in an archive would lead a run to files outside of it. `home` itself may be a
/// link, and so may folders that do not belong to an archive or a library.
void refuse_links(const std::filesystem::path& home);

}  // namespace semigeo::jobs
