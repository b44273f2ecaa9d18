#include "jobs/run/job_line.hpp"

#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>
#include <variant>

#include "jobs/archive/path_text.hpp"

namespace semigeo::jobs {
namespace {

using nlohmann::json;

/// Names every number and word of a result, for writing and for reading alike.
template <typename Visit>
void each_field(SurfaceJobResult& r, const Visit& visit) {
  visit("format", r.format);
  visit("vertices", r.vertices);
  visit("triangles", r.triangles);
  visit("parts", r.parts);
  visit("levels", r.levels);
  visit("vanished", r.vanished);
  visit("welded_vertices", r.repairs.welded_vertices);
  visit("degenerate_faces", r.repairs.degenerate_faces);
  visit("duplicate_faces", r.repairs.duplicate_faces);
  visit("flipped_faces", r.repairs.flipped_faces);
  visit("nonmanifold_faces", r.repairs.nonmanifold_faces);
  visit("split_vertices", r.repairs.split_vertices);
  visit("isolated_vertices", r.repairs.isolated_vertices);
  visit("holes_loops", r.preparation.holes.loops);
  visit("holes_filled", r.preparation.holes.filled);
  visit("holes_outer", r.preparation.holes.outer);
  visit("holes_too_long", r.preparation.holes.too_long);
  visit("holes_unsplittable", r.preparation.holes.unsplittable);
  visit("filled_vertices", r.preparation.filled_vertices);
  visit("filled_faces", r.preparation.filled_faces);
  visit("removed_vertices", r.preparation.removed_vertices);
  visit("removed_faces", r.preparation.removed_faces);
  visit("tolerance", r.preparation.tolerance);
  visit("distance_maximum", r.preparation.distance.maximum);
  visit("distance_sum", r.preparation.distance.sum);
  visit("distance_count", r.preparation.distance.count);
  visit("flipped", r.remeshed.flipped);
  visit("split", r.remeshed.split);
  visit("collapsed", r.remeshed.collapsed);
  visit("torn", r.remeshed.torn);
  visit("inserted", r.remeshed.inserted);
  visit("removed", r.remeshed.removed);
  visit("dropped_parts", r.remeshed.dropped_parts);
  visit("dropped_faces", r.remeshed.dropped_faces);
}

template <typename Visit>
void each_field(TripletsJobResult& r, const Visit& visit) {
  visit("features", r.features);
  visit("samples", r.samples);
  visit("triplets", r.triplets);
}

template <typename Visit>
void each_field(PartitionJobResult& r, const Visit& visit) {
  visit("postings", r.postings);
}

template <typename Visit>
void each_field(LibraryJobResult& r, const Visit& visit) {
  visit("models", r.models);
  visit("postings", r.postings);
  visit("digest", r.digest);
}

template <typename Visit>
void each_field(RecogniseJobResult& r, const Visit& visit) {
  visit("features", r.features);
  visit("triplets", r.triplets);
  visit("objects", r.objects);
}

template <typename Visit>
void each_field(std::monostate&, const Visit&) {}

/// Numbers of the kinds of results: their places in JobResult.
constexpr const char* kResultNames[] = {"",          "surface", "triplets",
                                        "partition", "library", "recognise"};
static_assert(std::size(kResultNames) == std::variant_size_v<JobResult>);

/// Null for none.
json to_json_object(JobResult result) {
  if (result.index() == 0) return nullptr;
  json object = {{"kind", kResultNames[result.index()]}};
  std::visit(
      [&](auto& one) {
        each_field(one, [&](const char* name, const auto& value) { object[name] = value; });
      },
      result);
  return object;
}

template <typename Result>
void read_result(const json& object, JobResult& found) {
  JobResult result = Result{};
  if (object.at("kind") != kResultNames[result.index()]) return;
  each_field(std::get<Result>(result),
             [&](const char* name, auto& value) { object.at(name).get_to(value); });
  found = std::move(result);
}

JobResult result_from(const json& object) {
  JobResult result;
  if (object.is_null()) return result;
  read_result<SurfaceJobResult>(object, result);
  read_result<TripletsJobResult>(object, result);
  read_result<PartitionJobResult>(object, result);
  read_result<LibraryJobResult>(object, result);
  read_result<RecogniseJobResult>(object, result);
  if (result.index() == 0) throw std::runtime_error("is no answer of a job: of no known kind");
  return result;
}

/// Whatever JSON has against a line is the same failure.
template <typename Read>
auto reading(const char* what, const std::string& line, const Read& read) {
  try {
    return read(json::parse(line));
  } catch (const json::exception& e) {
    throw std::runtime_error(std::string("is no ") + what + ": " + e.what());
  }
}

std::vector<std::string> escaped_list(std::vector<std::string> texts) {
  for (std::string& text : texts) text = escaped(text);
  return texts;
}

JobKind kind_from(const std::string& name) {
  for (const JobKind kind : kJobKinds)
    if (name == name_of(kind)) return kind;
  throw std::runtime_error("is no job: of no known kind: " + name);
}

}  // namespace

std::string to_line(const JobRequest& request) {
  const Job& job = request.job;
  return json{{"kind", name_of(job.kind)},
              {"input", escaped(job.input.string())},
              {"input_name", job.input_name},
              {"name", escaped(job.name)},
              {"output", escaped(job.output.string())},
              {"input_xxh3", job.input_xxh3},
              {"key", job.key},
              {"models", escaped_list(job.models)},
              {"shapes", {job.shapes.first, job.shapes.end}},
              {"library", escaped(job.library.string())},
              {"library_digest", job.library_digest},
              {"partitions", job.partitions},
              {"buffer_bytes", job.buffer_bytes},
              {"parameters", json::parse(to_json(request.parameters.surface))},
              {"recognition", json::parse(to_json(request.parameters.recognition))},
              {"search", json::parse(to_json(request.parameters.search))},
              {"sidecar_only", request.sidecar_only},
              {"threads", request.threads},
              {"memory_bytes", request.memory_bytes},
              {"log", escaped(request.log.string())}}
      .dump();
}

JobRequest job_request_from(const std::string& line) {
  return reading("job", line, [](const json& object) {
    const auto text = [&](const char* name) {
      return unescaped(object.at(name).get<std::string>());
    };
    JobRequest request;
    Job& job = request.job;
    job.kind = kind_from(object.at("kind").get<std::string>());
    job.input = text("input");
    object.at("input_name").get_to(job.input_name);
    job.name = text("name");
    job.output = text("output");
    object.at("input_xxh3").get_to(job.input_xxh3);
    object.at("key").get_to(job.key);
    for (const json& model : object.at("models"))
      job.models.push_back(unescaped(model.get<std::string>()));
    object.at("shapes").at(0).get_to(job.shapes.first);
    object.at("shapes").at(1).get_to(job.shapes.end);
    job.library = text("library");
    object.at("library_digest").get_to(job.library_digest);
    object.at("partitions").get_to(job.partitions);
    object.at("buffer_bytes").get_to(job.buffer_bytes);
    request.parameters.surface = surface_parameters_from_json(object.at("parameters").dump());
    request.parameters.recognition =
        recognition_parameters_from_json(object.at("recognition").dump());
    request.parameters.search = search_parameters_from_json(object.at("search").dump());
    object.at("sidecar_only").get_to(request.sidecar_only);
    object.at("threads").get_to(request.threads);
    object.at("memory_bytes").get_to(request.memory_bytes);
    request.log = text("log");
    return request;
  });
}

std::string to_line(const JobReply& reply) {
  switch (reply.kind) {
    case JobReply::Kind::kWorked:
      return json{{"worked", reply.worked}}.dump();
    case JobReply::Kind::kDone:
      return json{{"done", to_json_object(reply.result)},
                  {"worked", reply.worked},
                  {"cpu_seconds", reply.cpu_seconds},
                  {"peak_bytes", reply.peak_bytes}}
          .dump();
    case JobReply::Kind::kFailed:
      break;
  }
  // What the file system says need not be UTF-8.
  return json{{"failed", reply.error},
              {"worked", reply.worked},
              {"cpu_seconds", reply.cpu_seconds},
              {"peak_bytes", reply.peak_bytes}}
      .dump(-1, ' ', false, json::error_handler_t::replace);
}

JobReply job_reply_from(const std::string& line) {
  return reading("answer of a job", line, [](const json& object) {
    JobReply reply;
    object.at("worked").get_to(reply.worked);
    if (const auto failed = object.find("failed"); failed != object.end()) {
      failed->get_to(reply.error);
    } else if (const auto done = object.find("done"); done != object.end()) {
      reply.kind = JobReply::Kind::kDone;
      reply.result = result_from(*done);
    } else {
      reply.kind = JobReply::Kind::kWorked;
      return reply;
    }
    object.at("cpu_seconds").get_to(reply.cpu_seconds);
    object.at("peak_bytes").get_to(reply.peak_bytes);
    return reply;
  });
}

}  // namespace semigeo::jobs
