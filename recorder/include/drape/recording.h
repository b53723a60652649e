// A recorded run: the triangles of its bodies, their positions frame by frame, and the files made of them.
//
// Needs neither Bullet nor OpenCL, so that an app can also fill a recording itself. Lengths in metres, one frame of
// reference for all bodies. C++11.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "drape/export.h"

namespace drape
{
// One number per node and frame, which a replay page shows as colour.
struct RecordedChannel
{
    // Name for the reader, such as "gap".
    std::string m_name;
    // Unit of the values, such as "mm". May be empty.
    std::string m_unit;
    // Low end of the colour scale. A replay page keeps values between both ends to 1/508 of their distance, and shows
    // values beyond an end as the end.
    float m_low = 0;
    // High end of the colour scale; above m_low.
    float m_high = 1;
    // One value per node, frame after frame of the body. NaN means that there is none.
    std::vector<float> m_values;
};

// A soft body, or a rigid one with triangles.
struct RecordedBody
{
    // Name for the reader and for file names.
    std::string m_name;
    // Selects what m_frames holds: poses of a rigid body, or positions of vertices.
    bool m_rigid = false;
    // Three vertices for each triangle, counter-clockwise seen from outside.
    std::vector<std::int32_t> m_triangles;
    // Two vertices for each line: ropes, and links without faces.
    std::vector<std::int32_t> m_lines;
    // x y z per vertex, m: of a rigid body in its own frame, of others at their first frame.
    std::vector<float> m_vertices;
    // Frame of the recording in which the body appears.
    std::size_t m_first = 0;
    // A rigid body: x y z of its origin (m) and x y z w of its unit quaternion. Others: x y z per vertex, m. One group
    // a frame. A body whose groups end early is hidden from then on.
    std::vector<float> m_frames;
    // Values of the nodes.
    std::vector<RecordedChannel> m_channels;

    // Returns the number of vertices.
    std::size_t vertexCount() const { return m_vertices.size() / 3; }
    // Returns the floats of a frame in m_frames.
    std::size_t frameSize() const { return m_rigid ? 7 : m_vertices.size(); }
    // Returns the number of frames that the body has.
    std::size_t frameCount() const { return frameSize() > 0 ? m_frames.size() / frameSize() : 0; }
};

// One run.
struct Recording
{
    // Name of the run, shown above it.
    std::string m_title;
    // A line below the name. May be empty.
    std::string m_remark;
    // Time between two frames, s, > 0.
    double m_frameTime = 1.0 / 60;
    // Unit vector that points upwards.
    float m_up[3] = {0, 1, 0};
    // Number of frames.
    std::size_t m_frameCount = 0;
    // All bodies.
    std::vector<RecordedBody> m_bodies;
};

// Choices for a replay page.
struct ReplaySettings
{
    // Title of the page.
    std::string m_title = "Drape replay";
    // Distance between two positions that the page can tell apart, m; positions are off by half of it at most. 0 means
    // the size of the soft bodies at the start divided by 10,000.
    double m_resolution = 0;
    // Folder with three.js (three.min.js and examples/js/controls/OrbitControls.js), as Debian's package libjs-three
    // has it.
    std::string m_threeFolder = "/usr/share/javascript/three";
};

// Writes one HTML page that plays the runs side by side in a browser and needs no other file. Positions are rounded to
// ReplaySettings::m_resolution; those that are not finite repeat the frame before. Returns false with one line in
// `error`, and writes nothing, if three.js is missing, a recording's arrays do not fit together, or the file cannot be
// written.
DRAPE_RECORDER_EXPORT bool writeReplay(const std::string& path, const std::vector<const Recording*>& runs,
                                       const ReplaySettings& settings, std::string& error);

// Writes for each body an OBJ file, and for those that move point caches with the same vertices in the same order: PC2
// for Blender's modifier Mesh Cache, MDD for Houdini. Makes the folder. Names are those of the bodies, after their
// number. The numbers are exact. Returns false with one line in `error`, like writeReplay().
DRAPE_RECORDER_EXPORT bool writePointCaches(const std::string& folder, const Recording& run, std::string& error);

// Writes a binary glTF 2.0 file (.glb) with an animation: a morph target for each frame of a soft body, and poses of
// rigid bodies. For short clips: a target takes 12 bytes a node. If a body has more than `mostTargets` frames, evenly
// spaced ones are written, the last among them. Positions that are not finite repeat the frame before. Returns false
// with one line in `error`, like writeReplay().
DRAPE_RECORDER_EXPORT bool writeGltf(const std::string& path, const Recording& run, std::size_t mostTargets,
                                     std::string& error);
}  // namespace drape
