#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <memory>
#include <new>
#include <sstream>
#include <stdexcept>
#include <string>

#include "engine/lack_of_memory.hpp"
#include "io/files/error.hpp"
#include "io/files/small_file.hpp"
#include "jobs/cli/command.hpp"
#include "jobs/cli/help_formatter.hpp"
#include "jobs/cli/output.hpp"
#include "jobs/cli/version.hpp"

namespace {

/// Opens standard streams that the caller has closed. Otherwise a dataset could get their number,
/// and results would be printed into it. The replacement cannot be written.
void occupy_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) == -1) open("/dev/null", O_RDONLY);
}

bool results_were_written() {
  return std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
}

using namespace semigeo::jobs::cli;

/// Defines the commands, with their options, and does what the command line says.
int run_command_line(const std::string& version, int argc, char** argv) {
  CLI::App app{"semigeo turns archives of 3-D scans into multi-scale surface datasets.", "semigeo"};
  app.formatter(std::make_shared<HelpFormatter>());
  app.footer(
      "Examples:\n"
      "  semigeo run scans/ --output archive     every scan below scans/ gets a dataset\n"
      "  semigeo status archive                  how far is it?\n"
      "  semigeo info archive                    what is in it\n"
      "  semigeo report archive                  pages for a browser: archive/report/index.html\n"
      "  semigeo check archive                   is every byte as it was written?\n"
      "  semigeo prune archive                   remove what is of scans that are gone\n"
      "  semigeo recognise scene.ply --library archive   which models are in it, and where\n"
      "  semigeo picture archive/scans/x.ply.vtkhdf --output x.png\n"
      "  semigeo export archive/scans/x.ply.vtkhdf --level 4 --output smooth.ply\n"
      "  semigeo formats                         what is read and written\n"
      "  semigeo bench                           how fast is this machine?\n");
  app.set_version_flag("--version", version);
  app.set_config("--config", "", "Read options from a TOML file like archive/semigeo.toml");
  // The parser of options would wait for a pipe and read a file of any size.
  app.get_config_ptr()->check(CLI::Validator(
      [](const std::string& file) -> std::string {
        try {
          semigeo::io::read_text(file, {});
          return "";
        } catch (const semigeo::io::Error& e) {
          return e.what();
        }
      },
      "FILE"));
  app.allow_config_extras(CLI::config_extras_mode::error);
  app.require_subcommand(1);
  app.option_defaults()->always_capture_default();
  int exit_code = kAllDone;
  add_run(app, exit_code);
  add_status(app, exit_code);
  add_library(app, exit_code);
  add_recognise(app, exit_code);
  add_similar(app, exit_code);
  add_info(app, exit_code);
  add_check(app, exit_code);
  add_prune(app, exit_code);
  add_report(app, exit_code);
  add_picture(app, exit_code);
  add_export(app, exit_code);
  add_formats(app, exit_code);
  add_bench(app, exit_code);
  add_job(app, exit_code);
  add_options_page(app);
  add_system_files(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    std::ostringstream help;
    std::ostringstream problem;
    const bool ok = app.exit(e, help, problem) == 0;
    print_text(help.str());
    print_error(semigeo::io::printable_lines(problem.str()));
    return ok ? kAllDone : kUsage;
  }
  return exit_code;
}

int run(int argc, char** argv) {
  try {
    std::string version;
    try {
      version = version_text();
    } catch (const std::invalid_argument& e) {
      complain(e);
      return kUsage;
    }
    return run_command_line(version, argc, argv);
  } catch (const std::bad_alloc&) {
    complain("there is not enough memory; give less --memory or fewer --threads, or free some");
  } catch (const std::exception& e) {
    complain(e);
  }
  return kSomeFailed;
}

}  // namespace

int main(int argc, char** argv) {
  occupy_standard_streams();
  semigeo::engine::end_for_lack_of_memory(
      "semigeo: there is not enough memory; free some, and run the same command again\n",
      semigeo::jobs::cli::kSomeFailed);
  const int exit_code = run(argc, argv);
  if (results_were_written()) return exit_code;
  semigeo::jobs::cli::complain(
      "standard output cannot be written to its end; check the disk or what it is piped to");
  return exit_code == 0 ? semigeo::jobs::cli::kSomeFailed : exit_code;
}
