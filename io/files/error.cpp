#include "io/files/error.hpp"

#include <utility>

#include "io/files/printable.hpp"

namespace semigeo::io {
namespace {

std::string sentence(const std::filesystem::path& file, const std::string& place,
                     const std::string& problem, const std::string& remedy) {
  std::string text = file.string();
  if (!place.empty()) text += ": " + place;
  text += ": " + problem;
  if (!remedy.empty()) text += "; " + remedy;
  return text;
}

}  // namespace

Error::Error(std::filesystem::path file, std::string place, std::string problem, std::string remedy)
    : std::runtime_error(sentence(file, place, printable(problem), remedy)),
      file_(std::move(file)),
      place_(std::move(place)),
      problem_(printable(problem)),
      remedy_(std::move(remedy)) {}

}  // namespace semigeo::io
