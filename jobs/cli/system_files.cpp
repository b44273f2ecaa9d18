#include <filesystem>
#include <memory>
#include <string>

#include "io/files/atomic_file.hpp"
#include "jobs/cli/command.hpp"
#include "jobs/cli/completion.hpp"
#include "jobs/cli/manual.hpp"

namespace semigeo::jobs::cli {
namespace {

namespace fs = std::filesystem;

/// Writes the man pages and completions of the program below a folder.
void write_system_files(const CLI::App& program, const fs::path& folder) {
  const fs::path manuals = folder / "man1";
  fs::create_directories(manuals);
  const auto write = [](const fs::path& path, const std::string& text) {
    io::write_file_atomically(path, text, io::Folder::kLeft);
  };
  write(manuals / "semigeo.1", program_manual(program));
  for (const ShownCommand& command : shown_commands(program))
    if (!command.has_commands)
      write(manuals / (manual_name(command) + ".1"), command_manual(command));
  write(folder / "semigeo.bash", bash_completion(program));
  write(folder / "_semigeo", zsh_completion(program));
  write(folder / "semigeo.fish", fish_completion(program));
}

}  // namespace

void add_system_files(CLI::App& app) {
  auto folder = std::make_shared<std::string>();
  CLI::App* command =
      app.add_subcommand("system-files", "Write man pages and completions of shells");
  command->group("");
  command->add_option("folder", *folder, "The folder")->required();
  command->callback([&app, folder] { write_system_files(app, *folder); });
}

}  // namespace semigeo::jobs::cli
