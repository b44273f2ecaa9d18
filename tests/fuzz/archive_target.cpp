// The small files of an archive. The first byte chooses the file, the rest is its text. Checksums
// and digests are made right again.
#include <nlohmann/json.hpp>

#include "io/dataset/dataset_format.hpp"
#include "io/files/error.hpp"
#include "io/files/file_digest.hpp"
#include "io/files/small_file.hpp"
#include "jobs/archive/digest_cache.hpp"
#include "jobs/archive/estimates.hpp"
#include "jobs/archive/journal.hpp"
#include "jobs/archive/sources.hpp"
#include "jobs/archive/status.hpp"
#include "jobs/report/run_history.hpp"
#include "jobs/stages/recognised_file.hpp"
#include "tests/fuzz/target.hpp"

namespace semigeo::fuzz {
namespace {

using nlohmann::json;

/// Returns the text with a checksum for each line, which stands for a line without `{`.
std::string with_checksums(std::string_view text) {
  std::string journal;
  while (!text.empty()) {
    const std::string line(text.substr(0, text.find('\n')));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    journal += "{\"crc\":\"" + io::xxh3_of_text(line).substr(0, 8) + "\"," + line + "\n";
  }
  return journal;
}

void read_journal(std::string_view text, bool mend) {
  write(jobs::kJournalName, mend ? with_checksums(text) : std::string(text));
  jobs::read_journal(folder(), [](const jobs::JournalEntry&) {});
  jobs::read_journal(
      folder(), [](const jobs::JournalEntry&) {}, 100);
  jobs::learn_estimates(folder()).of(1e6, 9, 2);
  jobs::read_history(folder());
}

void read_digests(std::string_view text, bool mend) {
  const std::string begin = "semigeo-digests 2 " + std::to_string(io::kDatasetFormatVersion) + ' ';
  write("digests.txt", (mend ? begin + io::xxh3_of_text(text) + '\n' : "") + std::string(text));
  jobs::DigestCache cache = jobs::DigestCache::read(folder());
  cache.dataset_keys("a");
  cache.write();
}

void read_estimates(std::string_view text) {
  write("estimates.json", text);
  const jobs::Estimates estimates = jobs::Estimates::read(folder());
  const jobs::Estimate estimate = estimates.of({.format = "OBJ", .bytes = 1'000'000}, 9, 2);
  check(estimate.vertices > 0 && estimate.seconds > 0, "an estimate is not positive");
  check(estimate.peak_bytes > 0 && estimate.peak_bytes < 1e15, "an estimate is not credible");
  estimates.write(folder());
  check(jobs::Estimates::read(folder()).by_format() == estimates.by_format(),
        "estimates are not read back");
}

void read_sources(std::string_view text) {
  write("sources.json", text);
  jobs::Sources sources = jobs::Sources::read(folder());
  sources.write(folder());
  check(jobs::Sources::read(folder()).by_name() == sources.by_name(), "sources are not read back");
}

void read_recognised(std::string_view text, bool mend) {
  std::string content(text);
  json document = io::parse_json(content, {});
  if (mend && document.is_object()) {
    document["format"] = "semigeo-recognition";
    document["format_version"] = 1;
    document.erase("digest");
    document["digest"] = io::xxh3_of_text(document.dump());
    content = document.dump(2) + '\n';
  }
  jobs::recognised_key(write("recognised.json", content));
}

}  // namespace

void read_input(std::string_view bytes) {
  Numbers numbers(bytes);
  const unsigned kind = numbers.below(5);
  const bool mend = numbers.below(4) != 0;
  const std::string_view text = numbers.rest();
  try {
    if (kind == 0) read_journal(text, mend);
    if (kind == 1) read_digests(text, mend);
    if (kind == 2) read_estimates(text);
    if (kind == 3) read_sources(text);
    if (kind == 4) read_recognised(text, mend);
  } catch (const io::Error& error) {
    check(error.file().native().starts_with(folder().native()), "an error names another file");
  }
}

}  // namespace semigeo::fuzz
