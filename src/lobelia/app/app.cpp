#include "lobelia/app/app.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>

#include "lobelia/app/bench.h"
#include "lobelia/app/commands.h"
#include "lobelia/app/docs/command_texts.h"
#include "lobelia/app/docs/docs_command.h"
#include "lobelia/app/layer_commands.h"
#include "lobelia/app/methods.h"
#include "lobelia/app/option_checks.h"
#include "lobelia/app/precompute_command.h"
#include "lobelia/app/render.h"
#include "lobelia/app/signals.h"
#include "lobelia/app/unused_options.h"
#include "lobelia/app/view.h"
#include "lobelia/bsdf/captured_fit.h"
#include "lobelia/builtin/builtin_scenes.h"
#include "lobelia/io/scene_io.h"
#include "lobelia/version.h"

namespace lobelia::app {
namespace {

std::string quoted(int argc, char** argv) {
  std::string out;
  for (int i = 0; i < argc; ++i) out += (i > 0 ? " " : "") + std::string(argv[i]);
  return out;
}

// The command line's grammar and what it was told.
struct CommandLine {
  CLI::App app{"Lobelia: glossy global illumination with virtual lights", "lobelia"};
  GlobalOptions global;
  RenderOptions render;
  CompareOptions compare;
  FitOptions fit;
  InfoOptions info;
  ConvertOptions scene, convert;
  PrecomputeOptions precompute;
  BenchOptions bench;
  RelightOptions relight;
  ViewOptions view;
  ShowOptions show;
  CompletionOptions completion;
  DocsOptions docs;
  CLI::App *renderCommand, *compareCommand, *infoCommand, *methodsCommand, *sceneCommand,
      *convertCommand, *precomputeCommand, *benchCommand, *fitCommand, *viewCommand,
      *relightCommand, *showCommand, *completionCommand, *docsCommand;

  CommandLine() {
    app.set_version_flag("--version", std::string("lobelia ") + kVersion);
    app.require_subcommand(1);
    app.get_formatter()->column_width(32);
    renderCommand = app.add_subcommand("render", "Render a scene to a picture");
    addRenderOptions(*renderCommand, render);
    renderCommand->callback([this] { render.given = givenOptions(*renderCommand); });
    compareCommand = app.add_subcommand("compare", "Error of an image against a reference");
    compareCommand->add_option("image", compare.image, "Image to judge")
        ->type_name("FILE")
        ->required();
    compareCommand->add_option("reference", compare.reference, "What it should be")
        ->type_name("FILE")
        ->required();
    compareCommand
        ->add_option("--reference2", compare.reference2,
                     "Independent second reference: removes the references' noise from l2")
        ->type_name("FILE");
    compareCommand->add_option("--mask", compare.mask, "Compare only where this image is above 0.5")
        ->type_name("FILE");
    compareCommand->add_option("--diff", compare.diff, "Write a difference picture (FLIP) as PNG")
        ->type_name("FILE");
    compareCommand->add_flag("--json", compare.json, "Print JSON");
    fitCommand = app.add_subcommand("fit", "Fit captured reflectance to a table of MERL");
    fitCommand->add_option("table", fit.table, "MERL table (.binary)")
        ->type_name("FILE")
        ->required();
    fitCommand->add_option("-o,--output", fit.output, "Material: .xml to include, or .json")
        ->type_name("FILE");
    fitCommand->add_option("--lobes", fit.lobes, "Spherical Gaussians, at most")
        ->type_name("N")
        ->check(integerRange(1, kMaxFittedLobes))
        ->capture_default_str();
    fitCommand->add_flag("--json", fit.json, "Print JSON");
    infoCommand = app.add_subcommand("info", "Validate and describe a scene, with all warnings");
    addSceneOptions(*infoCommand, info.scene);
    infoCommand->get_option("scene")->description(
        "Scene file, the name of a built-in scene, or data of precompute");
    infoCommand->add_flag("--json", info.json, "Print JSON");
    methodsCommand =
        app.add_subcommand("methods", "Light models, gather strategies, what combines");
    sceneCommand = app.add_subcommand("scene", "Write a built-in scene as Mitsuba XML");
    addSceneOptions(*sceneCommand, scene.scene);
    sceneCommand->get_option("scene")
        ->type_name("SCENE")
        ->check(offered(builtin::builtinSceneNames()))
        ->description("Built-in scene");
    sceneCommand->add_option("-o,--output", scene.folder, "Folder to write")
        ->type_name("FOLDER")
        ->required();
    convertCommand = app.add_subcommand("convert", "Write any readable scene as Mitsuba XML");
    addSceneOptions(*convertCommand, convert.scene);
    convertCommand->add_option("-o,--output", convert.folder, "Folder to write")
        ->type_name("FOLDER")
        ->required();
    precomputeCommand = app.add_subcommand("precompute", "Compute what view needs of a scene");
    addPrecomputeOptions(*precomputeCommand, precompute);
    precomputeCommand->callback([this] { precompute.given = givenOptions(*precomputeCommand); });
    viewCommand =
        app.add_subcommand("view", "Change light and materials by hand, in a window or by frames");
    addViewOptions(*viewCommand, view);
    viewCommand->callback([this] { view.render.given = givenOptions(*viewCommand); });
    relightCommand =
        app.add_subcommand("relight", "Mix a picture's light groups anew, without rendering");
    addRelightOptions(*relightCommand, relight);
    showCommand = app.add_subcommand("show", "Write a layer of a picture as PNG");
    addShowOptions(*showCommand, show);
    benchCommand = app.add_subcommand("bench", "Regenerate a table of docs/performance.md");
    addBenchOptions(*benchCommand, bench);
    for (CLI::App* command : app.get_subcommands({})) {
      addGlobalOptions(*command, global);
      refuseEmptyValues(*command);
      command->footer(exampleFooter(command->get_name()));
    }
    completionCommand = app.add_subcommand("completion", "Print a script for a shell's completion");
    completionCommand->footer(exampleFooter("completion"));
    addCompletionOptions(*completionCommand, completion);
    app.footer(exampleFooter(""));
    docsCommand = app.add_subcommand("docs", "Print documents")->group("");
    addDocsOptions(*docsCommand, docs);
  }

  // CLI11 says of an unknown command only that one is required.
  void requireKnownCommand(int argc, char** argv) const {
    if (argc < 2 || argv[1][0] == '-') return;
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands({})) {
      if (command->get_name() == argv[1]) return;
      if (!command->get_group().empty()) names.push_back(command->get_name());
    }
    throw UsageError(fmt::format("'{}' is not a command; there are {}{}", argv[1],
                                 fmt::join(names, ", "), suggestion(argv[1], names)));
  }

  // What --help of the command in use is called.
  std::string help() const {
    const auto used = app.get_subcommands();
    return used.empty() ? "lobelia --help"
                        : fmt::format("lobelia {} --help", used.front()->get_name());
  }

  ExitCode dispatch(const std::string& text) const {
    if (*renderCommand) return app::render(render, global, text);
    if (*compareCommand) return compareImages(compare, global);
    if (*fitCommand) return app::fit(fit, global);
    if (*infoCommand) return app::info(info, global);
    if (*sceneCommand) {
      const std::vector<std::string> names = builtin::builtinSceneNames();
      if (std::find(names.begin(), names.end(), scene.scene.scene) == names.end()) {
        throw UsageError(fmt::format("'{}' is not a built-in scene; there are {}{}",
                                     scene.scene.scene, fmt::join(names, ", "),
                                     suggestion(scene.scene.scene, names)));
      }
      return app::convert(scene, global);
    }
    if (*convertCommand) return app::convert(convert, global);
    if (*precomputeCommand) return app::precompute(precompute, global);
    if (*viewCommand) return app::view(view, global, text);
    if (*relightCommand) return app::relight(relight);
    if (*showCommand) return app::show(show);
    if (*benchCommand) return app::bench(bench, global, text);
    if (*completionCommand) return app::completion(completion, app);
    if (*docsCommand) return app::docs(docs, app);
    fmt::print("{}", methodTable());
    return ExitCode::done;
  }
};

// Messages may quote what stands in a file: megabytes, or codes that would move the cursor.
std::string printable(const std::string& message) {
  constexpr size_t kLongest = 2000;
  std::string text = message.substr(0, kLongest);
  if (message.size() > kLongest) text += " ...";
  for (char& c : text)
    if ((c >= 0 && c < ' ') || c == 127) c = c == '\n' ? '\n' : '?';
  return text;
}

const CLI::App& commandInUse(const CLI::App& app) {
  const CLI::App* command = &app;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
  return *command;
}

// The first word that no command understood, with the nearest option of the command in use.
std::string unknownArgument(const CLI::App& app, int argc, char** argv) {
  std::vector<std::string> names;
  for (const CLI::Option* option : commandInUse(app).get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  for (const std::string& extra : app.remaining(true)) {
    if (!extra.starts_with("-")) continue;
    const std::string word = extra.substr(0, extra.find('='));
    return fmt::format("unknown option {}{}", word, suggestion(word, names));
  }
  // Values come back before the option they followed; the command line has the order.
  for (int i = 1; i < argc; ++i)
    for (const std::string& extra : app.remaining(true))
      if (extra == argv[i]) return fmt::format("'{}' is one argument too many", extra);
  return "arguments that nothing asks for";
}

// CLI11 counts where an option stands twice, and says neither that nor what to do.
std::string wrongCount(const CLI::App& app, const CLI::ArgumentMismatch& error) {
  for (const CLI::Option* option : commandInUse(app).get_options()) {
    const size_t most = static_cast<size_t>(option->get_items_expected_max());
    if (option->count() > most && most > 0)
      return fmt::format("{} is given {} times; it takes one value", option->get_name(),
                         option->count());
  }
  return error.what();
}

ExitCode fail(ExitCode code, const std::string& message) {
  fmt::print(stderr, "error: {}\n", printable(message));
  return code;
}

// What was printed is there only when it could be written: standard output may be a full disk.
ExitCode flushed(ExitCode code) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  return fail(ExitCode::failed,
              fmt::format("cannot write to standard output: {}", std::strerror(errno)));
}

}  // namespace

int run(int argc, char** argv) {
  ExitCode code = ExitCode::failed;
  survivableFileLimits();
  CommandLine line;
  try {
    line.requireKnownCommand(argc, argv);
    line.app.parse(argc, argv);
    code = flushed(line.dispatch(quoted(argc, argv)));
  } catch (const CLI::Success& e) {  // --help, --version
    line.app.exit(e);
    code = ExitCode::done;
  } catch (const CLI::ExtrasError&) {
    code = fail(ExitCode::usage, fmt::format("{}; `{}` lists what there is",
                                             unknownArgument(line.app, argc, argv), line.help()));
  } catch (const CLI::ArgumentMismatch& e) {
    code = fail(ExitCode::usage,
                fmt::format("{}; `{}` lists what there is", wrongCount(line.app, e), line.help()));
  } catch (const CLI::Error& e) {
    code =
        fail(ExitCode::usage, fmt::format("{}; `{}` lists what there is", e.what(), line.help()));
  } catch (const UsageError& e) {
    code = fail(ExitCode::usage, e.what());
  } catch (const InputError& e) {
    code = fail(ExitCode::input, e.what());
  } catch (const std::bad_alloc&) {
    code =
        fail(ExitCode::failed, "out of memory; lower --size, --num-lights or the scene's detail");
  } catch (const std::exception& e) {
    code = fail(ExitCode::failed, e.what());
  }
  return static_cast<int>(code);
}

}  // namespace lobelia::app
