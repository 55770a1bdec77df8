#include "lobelia/app/docs/command_texts.h"

#include <fmt/format.h>

#include <map>

#include "lobelia/base/error.h"

namespace lobelia::app {
namespace {

const std::map<std::string, CommandTexts>& texts() {
  static const std::map<std::string, CommandTexts> table{
      {"",
       {"Lobelia renders global illumination in glossy scenes with virtual lights: diffuse ones "
        "and "
        "spherical Gaussians. It brings the path tracer to judge the result by.\n\n"
        "Each command has a page of its own. A SCENE is a file (Mitsuba XML, PBRT-v4, glTF 2.0, "
        "OBJ, "
        "PLY) or the name of a built-in scene.",
        {},
        {{"lobelia render kitchen --spp 64 -o kitchen.exr -o kitchen.png",
          "Render a built-in scene to a linear and to a tone-mapped picture"},
         {"lobelia info scene.gltf", "See what is in a scene and what of it is not supported"}}}},
      {"render",
       {"Renders a scene and writes one or several pictures. Files are written whole or not at "
        "all. "
        "The same seed gives the same pixels for any number of threads.\n\n"
        "SIGINT and SIGTERM stop a render; what there is is written.",
        {{"*.exr",
          "Scene-linear RGB (sRGB primaries, 32-bit float), the layers of --aov, and metadata"},
         {"*.png", "Tone-mapped by Reinhard's global operator, sRGB"}},
        {{"lobelia render scene.xml -o picture.exr -o picture.png", "Glossy virtual lights"},
         {"lobelia render scene.xml --lights path --spp 256 -o reference.exr",
          "The same by path tracing"},
         {"lobelia render teapot --sky 3,1,0.5,1 -o teapot.png",
          "A built-in scene under sun and sky"}}}},
      {"compare",
       {"Prints errors of an image against a reference over the pixels that both have: rmse, "
        "relmse, "
        "l2, mae, flip, mean_ratio, and the number of values that are not finite.",
        {},
        {{"lobelia compare picture.exr reference.exr --diff difference.png",
          "Print the errors and write the FLIP map"}}}},
      {"fit",
       {"Fits a diffuse part and spherical Gaussians to a measured isotropic reflectance in the "
        "format of the MERL database and prints the error.",
        {{"*.binary", "Table of the MERL database"},
         {"*.xml", "Material to be included in a scene"},
         {"*.json", "The fit's numbers"}},
        {{"lobelia fit gold-metallic-paint.binary -o gold.xml --lobes 3",
          "Write a material of three lobes"}}}},
      {"info",
       {"Validates a scene and describes it, with all warnings; or says what a file of "
        "`precompute` "
        "holds, which needs no scene.",
        {},
        {{"lobelia info scene.pbrt --json", "Describe a scene as JSON"},
         {"lobelia info teapot.vmf", "Describe data of precompute"}}}},
      {"methods", {"Prints the light models, the gather strategies and which combine.", {}, {}}},
      {"scene",
       {"Writes a built-in scene as Mitsuba XML with PLY meshes and image files beside it.",
        {{"FOLDER/scene.xml", "The scene"}},
        {{"lobelia scene kitchen -o kitchen --detail 1.94",
          "Write the kitchen, finely tessellated"}}}},
      {"convert",
       {"Writes any readable scene as Mitsuba XML with PLY meshes and image files beside it.",
        {{"FOLDER/scene.xml", "The scene"}},
        {{"lobelia convert scene.glb -o scene", "Convert glTF to Mitsuba XML"}}}},
      {"precompute",
       {"Computes what is visible from the vertices of a scene (--method cuts), or how light from "
        "infinity comes to the eye over its glossy surfaces (--method vmf), and writes it to a "
        "file, from which pictures under other light and from other views come at once.\n\n"
        "The file belongs to the scene's shapes, and, of vmf, to its materials; lights and cameras "
        "may change, with cuts materials, too.",
        {{"DATA",
          "cuts: visibility cuts of all vertices, with the light samples and the tree over them; "
          "vmf: lobes of transfer"},
         {"DATA.work", "vmf: a folder of what is done so far, until all is"},
         {"*.json", "Statistics"}},
        {{"lobelia precompute sculpture.xml --method cuts -o sculpture.cuts",
          "For light from an environment"},
         {"lobelia precompute teapot --method vmf --bounces 3 -o teapot.vmf",
          "For glossy reflections of light from an environment"},
         {"lobelia precompute room --method cuts --light surfaces -o room.cuts",
          "For one bounce of light of lamps in a room"}}}},
      {"view",
       {"Opens a window in which materials, lights and camera are changed by hand, or, with "
        "--headless, draws frames into files.\n\n"
        "Pictures come from precomputed visibility (--data): light from infinity (environments, "
        "suns, directional emitters) that arrives straight at the first surface, and light of "
        "lamps in the scene with one bounce of it, each by data of its own. Light, materials and "
        "camera may be other ones than before; the geometry may not. Light from infinity does not "
        "come through materials that transmit; light of lamps does, straight, and what is behind "
        "smooth ones is seen. Data of --method vmf show light from infinity with its reflections, "
        "on the materials that they were made with. In the window, and in scripts, the methods of "
        "`render` "
        "draw all light, pass by pass.",
        {{"DATA", "Visibility cuts of the scene's vertices, or their transfer"},
         {"*.exr", "Scene-linear RGB (sRGB primaries, 32-bit float), and metadata"},
         {"*.png", "Tone-mapped by Reinhard's global operator, sRGB"}},
        {{"lobelia view machine --data machine.cuts", "The window"},
         {"lobelia view teapot --sky 3,1,0.5,1 --data teapot.cuts --headless -o teapot.png",
          "One picture under sun and sky"},
         {"lobelia view cornell --data cornell.cuts --headless -o cornell.png",
          "Lamps and one bounce of their light, by data of --light surfaces"},
         {"lobelia view scene.xml --data scene.cuts --headless --frames 36 --rotate-step 10 -o "
          "turn%02d.exr",
          "The environment turns once around the scene"},
         {"lobelia view teapot --data teapot.vmf --headless --bounce 1 -o once.png",
          "Of transfer, the light that was reflected once before"},
         {"lobelia view scene.xml --data scene.cuts --headless --script edits.txt -o %04d.png",
          "Frames, edits and designs that a script says"}}}},
      {"relight",
       {"Multiplies the light groups of a picture rendered with --aov groups by factors and "
        "colours "
        "and writes their sum.",
        {{"*.exr", "The new picture with its groups, which can be relit again"},
         {"*.png", "Tone-mapped"}},
        {{"lobelia relight room.exr --group window=0.2 --group lamp=3,1,0.8,0.6 -o evening.png",
          "Dim the window, brighten and warm the lamp"}}}},
      {"show",
       {"Writes one layer of a picture as PNG, tone-mapped or in false colours (cubehelix), and "
        "prints which values these begin and end at.",
        {{"*.png", "The layer"}},
        {{"lobelia show kitchen.exr --layer cost --false-colour -o heat.png",
          "Where the rays of a render with --aov cost went"}}}},
      {"bench",
       {"Runs a study and prints its tables as Markdown, as they stand in docs/performance.md.",
        {{"FOLDER/vsl.md, vsgl.md, sglc.md, cuts.md",
          "vsl, vsgl, sglc, cuts, vmf: tables and pictures on one page"},
         {"FOLDER/figure*.exr, .png", "vsl, sglc, cuts, vmf: the pictures"},
         {"FOLDER/figure*.svg", "sglc, cuts: the curves"}},
        {{"lobelia bench rates --json rates.json", "Measure rays per second"},
         {"lobelia bench vsl -o figures --json figures.json",
          "Figures of the paper on virtual spherical lights"},
         {"lobelia bench vsgl --scene box --figures time", "Time of pictures with VSGLs"},
         {"lobelia bench cuts --scene statue --figures 9", "Visibility cuts: data and frames"},
         {"lobelia bench cuts --figures 5,8 -o figures",
          "Light trees by three metrics, and Haar wavelets beside cuts"},
         {"lobelia bench vmf --scene teapot-128 --figures table1,hash",
          "Glossy transfer: data and frames"},
         {"lobelia bench sglc --figures table2,8 -o figures",
          "Gather strategies side by side: their table, and error over time"}}}},
      {"completion",
       {"Prints a script that completes commands, options and values in a shell. Installation puts "
        "the scripts where the shells look for them.",
        {},
        {{"source <(lobelia completion bash)", "Use it in the running bash"},
         {"lobelia completion zsh > ~/.zfunc/_lobelia",
          "For zsh, in a folder of its fpath (before compinit)"},
         {"lobelia completion fish > ~/.config/fish/completions/lobelia.fish", "For fish"}}}},
  };
  return table;
}

std::string code(ExitCode value) { return std::to_string(static_cast<int>(value)); }

}  // namespace

const CommandTexts& commandTexts(const std::string& command) { return texts().at(command); }

const std::vector<NamedText>& exitCodeTexts() {
  static const std::vector<NamedText> table{
      {code(ExitCode::done), "Done"},
      {code(ExitCode::failed), "Failed while running (disk full, out of memory)"},
      {code(ExitCode::usage), "Wrong usage"},
      {code(ExitCode::input),
       "Unreadable or invalid input; the message names file, line, what is wrong, what would be "
       "right"},
      {code(ExitCode::interrupted), "Stopped by SIGINT, after writing what there is"},
      {code(ExitCode::terminated), "Stopped by SIGTERM, after writing what there is"},
  };
  return table;
}

std::string exampleFooter(const std::string& command) {
  std::string out;
  for (const NamedText& example : commandTexts(command).examples)
    out += fmt::format("{}  {}\n      {}\n", out.empty() ? "Examples:\n" : "", example.name,
                       example.text);
  return out;
}

}  // namespace lobelia::app
