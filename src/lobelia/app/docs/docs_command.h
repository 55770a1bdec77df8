// `lobelia docs` (not listed by --help; for the build, the repository's documents and their tests)
// and `lobelia completion`.
#pragma once

#include <string>

#include "lobelia/base/error.h"

namespace CLI {
class App;
}

namespace lobelia::app {

struct DocsOptions {
  std::string kind;      // man, markdown, gallery, files
  std::string argument;  // man: the command; files: the folder
};
struct CompletionOptions {
  std::string shell;
};

void addDocsOptions(CLI::App& command, DocsOptions& options);
void addCompletionOptions(CLI::App& command, CompletionOptions& options);

// app: the whole command line, which is described.
ExitCode docs(const DocsOptions& options, const CLI::App& app);
ExitCode completion(const CompletionOptions& options, const CLI::App& app);

}  // namespace lobelia::app
