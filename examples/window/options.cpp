#include "examples/window/options.h"

#include <CLI/CLI.hpp>

#include "examples/window/window_scenes.h"
#include "tools/common/arguments.h"
#include "tools/common/suggestion.h"
#include "tools/scene_file/built_in_scene.h"

namespace drape::window
{
namespace
{
struct NamedDraw
{
    const char* m_name;
    unsigned m_flag;
};

constexpr NamedDraw kDraws[] = {{"contacts", kDrawContacts}, {"normals", kDrawNormals}, {"gaps", kDrawGaps},
                                {"patches", kDrawPatches},   {"flagged", kDrawFlagged}, {"impulses", kDrawImpulses}};

std::vector<std::string> drawNames()
{
    std::vector<std::string> names;
    for (const NamedDraw& draw : kDraws)
        names.emplace_back(draw.m_name);
    return names;
}
}  // namespace

bool parse(int argc, const char* const* argv, Options& options, int& exitCode)
{
    CLI::App app("Shows cloth with Drape, or with Bullet's own collision, in a window.", "drape_window");
    std::vector<std::string> draws;
    std::string collision = "drape";
    offerWords(app.add_option("--scene", options.m_scene, "built-in scene or scene file (JSON) to start with")
                   ->type_name("FILE|NAME"),
               windowSceneNames());
    app.add_flag("--list-scenes", options.m_listScenes, "list the built-in scenes and exit");
    acceptOnly(app.add_option("--collision", collision, "drape, or bullet for Bullet's own collision"),
               {"drape", "bullet"});
    acceptOnly(app.add_option("--draw", draws,
                              "what to draw of the contacts: contacts, normals, gaps, patches, "
                              "flagged, impulses")
                   ->delimiter(','),
               drawNames());
    app.add_option("--frames", options.m_frames, "end after this many frames, one step each")
        ->check(CLI::Validator(wholeNumber(1, 1000000), ""));
    app.add_option("--screenshot", options.m_screenshot, "PNG file of the last frame; needs --frames")
        ->type_name("FILE");
    const CLI::Validator width(wholeNumber(320, 7680), ""), height(wholeNumber(240, 4320), "");
    app.add_option("--width", options.m_width, "width of the window, pixels")->check(width);
    app.add_option("--height", options.m_height, "height of the window, pixels")->check(height);
    app.add_option("--detail", options.m_detail, "fineness of the cloth of a built-in scene, 1 to 8")
        ->check(CLI::Validator(wholeNumber(1, 8), ""));
    acceptOnly(app.add_option("--backend", options.m_backend, "auto, opencl, host or cost, as in cloth_drop"),
               {"auto", "opencl", "host", "cost"});
    app.add_option("--device", options.m_device, "part of an OpenCL device's name");
    app.add_option("--models", options.m_models, "folder with bunny.obj")->type_name("DIR");
    const auto conflict = [&]
    {
        const bool endless = !options.m_screenshot.empty() && options.m_frames == 0;
        if (endless) return std::string("--screenshot needs --frames, which says when it is taken");
        const bool isKnown = isWindowScene(options.m_scene) || isSceneFile(options.m_scene);
        return isKnown ? "" : "--scene: " + unknownWord(options.m_scene, windowSceneNames());
    };
    if (!parseArguments(app, argc, argv, conflict, exitCode)) return false;
    options.m_bullet = collision == "bullet";
    for (const NamedDraw& draw : kDraws)
        for (const std::string& name : draws)
            if (name == draw.m_name) options.m_draws |= draw.m_flag;
    return true;
}
}  // namespace drape::window
