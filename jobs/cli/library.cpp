#include <algorithm>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/files/error.hpp"
#include "io/files/read_error.hpp"
#include "io/library/hash_library.hpp"
#include "jobs/archive/verification.hpp"
#include "jobs/cli/command.hpp"
#include "jobs/cli/datasets.hpp"
#include "jobs/cli/json_output.hpp"
#include "jobs/cli/output.hpp"
#include "jobs/cli/run_plan.hpp"
#include "jobs/kinds/given_names.hpp"
#include "jobs/kinds/library_plan.hpp"
#include "jobs/kinds/triplets.hpp"

namespace semigeo::jobs::cli {
namespace {

namespace fs = std::filesystem;
using Models = std::map<std::string, LibraryModel>;

struct LibraryOptions {
  ExecutionOptions execution;
  std::string library;
  std::vector<std::string> inputs;  ///< Archives and datasets, or names of models.
};

/// Returns the same path for every path to one file.
fs::path resolved(const fs::path& path) {
  std::error_code error;
  fs::path result = fs::weakly_canonical(path, error);
  return error ? fs::absolute(path) : result;
}

/// Returns where the library with this file name is made.
LibraryPlace place_at(const std::string& library) {
  return place_of(fs::absolute(library).lexically_normal());
}

/// Returns the library of an archive, or the file itself.
std::string library_file(const std::string& file_or_archive) {
  if (!io::is_folder(file_or_archive)) return file_or_archive;
  return place_of_archive(file_or_archive).library.string();
}

bool is_archive(const fs::path& path) {
  return io::is_folder(path / "scans");
}

/// Returns the datasets by name. Throws io::Error if two have the same name, because they would be
/// one model.
Models models_in(const std::vector<std::string>& inputs) {
  Models models;
  for (const std::string& input : inputs) {
    for (const fs::path& dataset : datasets_at(input)) {
      LibraryModel model = model_of(resolved(dataset));
      const auto [at, is_new] = models.try_emplace(model.name, model);
      if (!is_new && at->second.dataset != model.dataset)
        throw io::Error(
            dataset, "",
            "has the name of another dataset that was given, " + at->second.dataset.string(),
            "rename one of the files: models are told by the names of their datasets");
    }
  }
  return models;
}

/// Returns the models of the library, which are kept as they are. Throws io::Error if it was made
/// with other parameters, or if its parts are gone.
Models kept_models(const LibraryPlace& place, const RecognitionParameters& parameters) {
  const io::HashLibrary library(place.library);
  constexpr const char* kRemedy = "build it anew: semigeo library build DATASETS --output LIBRARY";
  if (library.parameters() != json_of(parameters))
    throw io::Error(place.library, "", "was made with other parameters", kRemedy);
  Models models;
  for (const io::ModelInfo& info : library.models()) {
    const fs::path run = run_path(place.parts, info.name);
    if (output_key(triplets_kind(), run, KeyCheck::kWhole).empty())
      throw io::Error(run, "", "is missing or damaged: the triplets of " + info.name, kRemedy);
    models[info.name] = {.name = info.name};
  }
  return models;
}

std::vector<LibraryModel> in_order(const Models& models) {
  std::vector<LibraryModel> list;
  for (const auto& [name, model] : models) list.push_back(model);
  return list;
}

/// Makes the library of the models that `models` returns. `models` is called after the folder of
/// the library was locked.
int make(LibraryOptions& options, const LibraryPlace& place,
         const std::function<std::vector<LibraryModel>(DigestCache&)>& models) {
  const auto plan_of = [&](DigestCache& cache) {
    std::vector<PlannedJob> plan;
    plan_library(plan, models(cache), place, {});
    if (options.execution.verify) verify_library_plan(plan);
    return plan;
  };
  return run_plan(options.execution,
                  {.home = place.home, .plan = plan_of, .is_archive = place.home != place.parts});
}

int build(LibraryOptions& options) {
  const bool of_archive = options.inputs.size() == 1 && is_archive(options.inputs.front());
  if (!of_archive && options.library.empty())
    throw CLI::ValidationError("--output", "give the library's file, or one archive alone");
  const fs::path archive = of_archive ? fs::absolute(options.inputs.front()) : fs::path();
  const LibraryPlace place =
      options.library.empty() ? place_of_archive(archive) : place_at(options.library);
  if (of_archive && resolved(place.home) == resolved(archive))
    return make(options, place, [&](DigestCache& cache) { return models_of(archive, {}, cache); });
  const Models models = models_in(options.inputs);
  return make(options, place, [&](DigestCache&) { return in_order(models); });
}

int add(LibraryOptions& options) {
  const LibraryPlace place = place_at(options.library);
  io::library_key(place.library);  // throws if it is not a library, before anything is made
  const Models added = models_in(options.inputs);
  return make(options, place, [&](DigestCache&) {
    Models models = kept_models(place, {});
    for (const auto& [name, model] : added) models[name] = model;
    return in_order(models);
  });
}

int remove(LibraryOptions& options) {
  const LibraryPlace place = place_at(options.library);
  io::library_key(place.library);
  return make(options, place, [&](DigestCache&) {
    Models models = kept_models(place, {});
    for (const std::string& name : options.inputs)
      if (models.erase(name) == 0)
        throw io::Error(place.library, "", "has no model " + name,
                        "see `semigeo library list` for their names");
    if (models.empty())
      throw io::Error(place.library, "", "would have no model left", "remove the file instead");
    return in_order(models);
  });
}

int list(const LibraryOptions& options) {
  const io::HashLibrary library(options.library);
  const GivenNames given(options.library);
  if (options.execution.json) {
    auto models = nlohmann::json::array();
    for (const io::ModelInfo& model : library.models()) {
      models.push_back({{"name", model.name},
                        {"digest", model.digest},
                        {"diagonal", model.diagonal},
                        {"features", model.features},
                        {"samples", model.samples},
                        {"triplets", model.triplets}});
      if (const fs::path scan = given.scan_of(model.name); !scan.empty())
        models.back()["scan"] = scan.string();
    }
    print_document({{"models", models},
                    {"postings", library.posting_count()},
                    {"parameters", library.parameters()},
                    {"digest", library.digest()}});
    return kAllDone;
  }
  for (const io::ModelInfo& model : library.models())
    print(given.shown(model.name), ": ", model.features, " features, ", model.triplets,
          " triplets, diagonal ", model.diagonal, "\n");
  print(library.models().size(), " models, ", library.posting_count(), " triplets\n");
  return kAllDone;
}

int check(const LibraryOptions& options) {
  if (!io::is_there(options.library))
    throw io::Error(options.library, "", "no such file", "check the path");
  const auto [problem, was_read] = verify_libraries({options.library}).front();
  if (options.execution.json) {
    nlohmann::json document = {{"file", options.library}, {"ok", problem.empty()}};
    if (!problem.empty()) document["error"] = problem;
    print_document(document);
  } else if (problem.empty()) {
    print(options.library, ": every byte is as it was written\n");
  } else {
    print(std::string(was_read ? "broken: " : "not read: "), problem, "\n");
  }
  return problem.empty() ? kAllDone : kSomeFailed;
}

using Action = int (*)(LibraryOptions&);

/// Adds a subcommand that makes a library.
void add_maker(CLI::App* parent, const char* name, const char* about, const char* inputs,
               const char* what, Action action, int& exit_code) {
  auto options = std::make_shared<LibraryOptions>();
  CLI::App* command = parent->add_subcommand(name, about);
  const bool is_build = std::string(name) == "build";
  if (!is_build)
    command->add_option("library", options->library, "The library, or an archive that has one")
        ->required()
        ->configurable(false);
  command->add_option(inputs, options->inputs, what)
      ->default_str("")
      ->required()
      ->configurable(false);
  if (is_build)
    command
        ->add_option("-o,--output", options->library,
                     "The library, if it is not ARCHIVE/library.h5; LIBRARY.parts beside it keeps\n"
                     "the triplets of its models")
        ->configurable(false);
  add_execution_options(*command, options->execution);
  command->fallthrough();
  command->callback([options, action, is_build, &exit_code] {
    complete(options->execution);
    if (!is_build) options->library = library_file(options->library);
    exit_code = action(*options);
  });
}

/// Adds a subcommand that reads a library.
void add_reader(CLI::App* parent, const char* name, const char* about,
                int (*action)(const LibraryOptions&), int& exit_code) {
  auto options = std::make_shared<LibraryOptions>();
  CLI::App* command = parent->add_subcommand(name, about);
  command->add_option("library", options->library, "The library, or an archive that has one")
      ->required();
  command->add_flag("--json", options->execution.json, "As JSON");
  command->callback([options, action, &exit_code] {
    options->library = library_file(options->library);
    exit_code = action(*options);
  });
}

}  // namespace

void add_library(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("library", "Hash libraries, in which scenes are recognised");
  command->footer(
      "Examples:\n"
      "  semigeo library build archive                  archive/library.h5, of all its datasets\n"
      "  semigeo library build a.vtkhdf b.vtkhdf --output mine.h5\n"
      "  semigeo library add mine.h5 archive            more models; the others are not made "
      "again\n"
      "  semigeo library remove mine.h5 a\n"
      "  semigeo library list mine.h5                   its models\n"
      "  semigeo library check mine.h5                  is every byte as it was written?\n"
      "\n"
      "What is up to date is left alone. A model has the name of its dataset, without .vtkhdf. "
      "The\n"
      "library of an archive has all of it again after the next build or `run --library`.\n");
  command->require_subcommand(1);
  command->fallthrough();
  add_maker(command, "build", "Make a library of datasets", "datasets",
            "Datasets and archives; one archive alone has its own library", build, exit_code);
  add_maker(command, "add", "Add models to a library, or replace them", "datasets",
            "Datasets and archives", add, exit_code);
  add_maker(command, "remove", "Remove models from a library", "models", "Names of models", remove,
            exit_code);
  add_reader(command, "list", "Name the models of a library", list, exit_code);
  add_reader(command, "check", "Read a library back and say what is broken", check, exit_code);
}

}  // namespace semigeo::jobs::cli
