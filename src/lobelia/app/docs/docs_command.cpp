#include "lobelia/app/docs/docs_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <span>

#include "lobelia/app/docs/completion.h"
#include "lobelia/app/docs/writers.h"
#include "lobelia/app/option_checks.h"
#include "lobelia/base/file.h"

namespace lobelia::app {
namespace {

struct Shell {
  const char* name;
  std::string (*script)(const ProgramDoc&);
  const char* file;  // where the shell looks for it, below the prefix's share/
};
constexpr Shell kShells[] = {
    {"bash", bashCompletion, "bash-completion/completions/lobelia"},
    {"zsh", zshCompletion, "zsh/site-functions/_lobelia"},
    {"fish", fishCompletion, "fish/vendor_completions.d/lobelia.fish"},
};

void write(const std::filesystem::path& file, const std::string& text) {
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  if (error)
    throw RuntimeError(
        fmt::format("cannot make {}: {}", file.parent_path().string(), error.message()));
  writeFileAtomically(file, std::as_bytes(std::span<const char>(text)));
}

// Man pages and completion, in folders as below an installation's share/.
void writeFiles(const std::filesystem::path& folder, const ProgramDoc& doc) {
  const auto page = [&](const CommandDoc& command) {
    write(folder / "man/man1" / (manPageName(doc, command) + ".1"), manPage(doc, command));
  };
  page(doc.program);
  for (const CommandDoc& command : doc.commands) page(command);
  for (const Shell& shell : kShells) write(folder / shell.file, shell.script(doc));
}

const CommandDoc& findCommand(const ProgramDoc& doc, const std::string& name) {
  if (name.empty()) return doc.program;
  for (const CommandDoc& command : doc.commands)
    if (command.name == name) return command;
  throw UsageError(fmt::format("'{}' is not a command; there are {}{}", name,
                               fmt::join(commandNames(doc), ", "),
                               suggestion(name, commandNames(doc))));
}

}  // namespace

void addDocsOptions(CLI::App& c, DocsOptions& o) {
  c.add_option("kind", o.kind, "What to print; files: write man pages and completion to a folder")
      ->required()
      ->type_name("KIND")
      ->check(oneOf({"man", "markdown", "gallery", "files"}));
  c.add_option("argument", o.argument, "man: a command (none: the program); files: the folder")
      ->type_name("COMMAND|FOLDER");
}

void addCompletionOptions(CLI::App& c, CompletionOptions& o) {
  std::vector<std::string> shells;
  for (const Shell& shell : kShells) shells.emplace_back(shell.name);
  c.add_option("shell", o.shell, "Shell that will complete")
      ->required()
      ->type_name("SHELL")
      ->check(oneOf(shells));
}

ExitCode docs(const DocsOptions& options, const CLI::App& app) {
  const ProgramDoc doc = describe(app);
  if (options.kind == "files") {
    if (options.argument.empty()) throw UsageError("docs files: name the folder to write to");
    writeFiles(options.argument, doc);
  } else if (options.kind == "man") {
    fmt::print("{}", manPage(doc, findCommand(doc, options.argument)));
  } else {
    if (!options.argument.empty())
      throw UsageError(fmt::format("docs {} takes no further argument", options.kind));
    fmt::print("{}", options.kind == "gallery" ? gallery() : optionReference(doc));
  }
  return ExitCode::done;
}

ExitCode completion(const CompletionOptions& options, const CLI::App& app) {
  for (const Shell& shell : kShells)
    if (options.shell == shell.name) fmt::print("{}", shell.script(describe(app)));
  return ExitCode::done;
}

}  // namespace lobelia::app
