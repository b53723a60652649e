#include "examples/window/options.h"

#include <CLI/CLI.hpp>

#include "examples/window/window_scenes.h"
#include "tools/common/arguments.h"

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
    acceptOnly(app.add_option("--scene", options.m_scene, "Scene to start with; --list-scenes names them"),
               windowSceneNames());
    app.add_flag("--list-scenes", options.m_listScenes, "Print the names of the scenes");
    acceptOnly(app.add_option("--collision", collision, "drape, or bullet for Bullet's own collision"),
               {"drape", "bullet"});
    acceptOnly(app.add_option("--draw", draws,
                              "What to draw of the contacts: contacts, normals, gaps, patches, "
                              "flagged, impulses")
                   ->delimiter(','),
               drawNames());
    app.add_option("--frames", options.m_frames, "End after this many frames, one step each")
        ->check(CLI::Validator(wholeNumber(1, 1000000), ""));
    app.add_option("--screenshot", options.m_screenshot, "PNG file of the last frame; needs --frames");
    const CLI::Validator width(wholeNumber(320, 7680), ""), height(wholeNumber(240, 4320), "");
    app.add_option("--width", options.m_width, "Width of the window in pixels")->check(width);
    app.add_option("--height", options.m_height, "Height of the window in pixels")->check(height);
    app.add_option("--detail", options.m_detail, "Fineness of the cloth")->check(CLI::Validator(wholeNumber(1, 8), ""));
    acceptOnly(app.add_option("--backend", options.m_backend, "auto, opencl or host"), {"auto", "opencl", "host"});
    app.add_option("--device", options.m_device, "Part of an OpenCL device's name");
    app.add_option("--models", options.m_models, "Folder with bunny.obj");
    const auto conflict = [&]
    {
        const bool endless = !options.m_screenshot.empty() && options.m_frames == 0;
        return std::string(endless ? "--screenshot needs --frames, which says when it is taken" : "");
    };
    if (!parseArguments(app, argc, argv, conflict, exitCode)) return false;
    options.m_bullet = collision == "bullet";
    for (const NamedDraw& draw : kDraws)
        for (const std::string& name : draws)
            if (name == draw.m_name) options.m_draws |= draw.m_flag;
    if (options.m_draws & kDrawImpulses) options.m_draws |= kDrawNormals;
    return true;
}
}  // namespace drape::window
