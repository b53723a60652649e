// The command line of cloth_drop: what to drop, on what, on which back end, and what to write.
// Lengths in metres, times in seconds. parseOptions checks every value, so that the rest of the program may trust them.
#pragma once

#include <string>

#include "tools/common/program.h"

namespace drape
{
enum class BulletMode
{
    Stock,    // the sparse distance field as Bullet sets it up
    Tuned,    // more and smaller voxels
    SoftPair  // the obstacle as a second soft body, vertices against faces
};

struct Options
{
    std::string m_obstacle = "sphere";  // a shape's name or a file
    std::string m_scene;                // a scene file or a built-in scene; empty: the drop on the obstacle
    std::string m_writeScene;
    int m_seed = 1, m_detail = 1, m_sheets = 8;  // for a built-in scene
    bool m_listScenes = false, m_listMaterials = false;
    bool m_stepsGiven = false, m_dtGiven = false;  // on the command line
    double m_obstacleSize = 2.0;
    int m_clothColumns = 33;
    int m_clothRows = 33;
    double m_clothSize = 2.4;
    int m_layers = 1;
    bool m_self = false;
    double m_dropHeight = 0.3;
    double m_dropSpeed = 0;
    int m_steps = 240;
    double m_timeLimit = 0;  // s; 0: none
    double m_dt = 1.0 / 60.0;
    double m_thickness = 0.02;
    std::string m_backend = "auto";
    std::string m_contactMode = "automatic";  // discrete, continuous or automatic: Settings::m_mode
    std::string m_solverPlace = "auto";       // auto, host or device: Settings::m_solverPlace
    std::string m_solver = "auto";            // auto, drape or bullet: Settings::m_solver
    BulletMode m_bulletMode = BulletMode::Stock;
    std::string m_device;
    bool m_listDevices = false;
    unsigned m_threads = 0;  // see Settings
    bool m_compare = false;
    bool m_compareSoftPair = false;
    double m_compareCap = 60.0;
    std::string m_csv, m_json, m_frames, m_picture;
    std::string m_replay, m_pointCache, m_gltf, m_animation;
    std::string m_validateHash;  // 16 lower-case hex digits or empty
    bool m_quiet = false;
    bool m_streamSteps = false;      // for a child of --compare: a line a step on standard output, nothing else
    bool m_streamPositions = false;  // each line with the nodes' positions
    bool m_streamFrames = false;     // each line with a frame of the recording

    bool usesDrape() const { return m_backend != "bullet"; }
    // Returns whether an output needs all frames.
    bool records() const
    {
        return !m_replay.empty() || !m_pointCache.empty() || !m_gltf.empty() || !m_animation.empty() || m_streamFrames;
    }
};

// Returns true if the program goes on. Returns false if it must leave with `exitCode`, after printing the help or one
// line on standard error.
bool parseOptions(int argc, const char* const* argv, Options& options, int& exitCode);
}  // namespace drape
