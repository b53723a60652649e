// Records the soft bodies and rigid bodies of a Bullet world, step by step: with Drape, or with Bullet alone.
//
//   drape::Recorder recorder(world);
//   … world.stepSimulation(…); recorder.record(); …
//   drape::writeReplay("replay.html", {&recorder.recording()}, drape::ReplaySettings(), error);
//
// Input: the world after a step. Output: a Recording. Cost: a copy of the nodes a step; gaps take some milliseconds for
// a thousand nodes on a large mesh. Needs no plugin and no OpenCL. Not for several threads at once. Lengths in metres.
// May throw std::bad_alloc. C++11.
#pragma once

#include <memory>

#include "drape/export.h"
#include "drape/precision.h"
#include "drape/recording.h"

class btCollisionWorld;
class btSoftBody;

namespace drape
{
// Choices of a recorder.
struct RecorderSettings
{
    // Time between two calls of record(), s, > 0.
    double m_frameTime = 1.0 / 60;
    // Records gaps, which costs more than all else.
    bool m_gaps = true;
};

// Records a world. Each soft body gets three channels:
//
// - contact: 1 for a node that is in contact, else 0, from the lists of Bullet's own collision and addContacts();
// - gap, mm: the distance from the node to the nearest triangle of a mesh, plane or height field, the sum of both
//   margins subtracted. Negative values below that distance. A node inside a closed mesh counts with a negative
//   distance. No value farther away than four times the body's margin (at most 100 mm);
// - stretch, %: the largest extension of the node's links, against their rest lengths. No value without links.
class DRAPE_RECORDER_EXPORT Recorder
{
public:
    // The world must outlive the recorder or its last record().
    explicit Recorder(const btCollisionWorld& world, const RecorderSettings& settings = RecorderSettings());
    // Forgets the recording.
    ~Recorder();
    // Recorders are not copied.
    Recorder(const Recorder&) = delete;
    // Recorders are not copied.
    Recorder& operator=(const Recorder&) = delete;

    // Appends a frame: every soft body, and every other object whose shape has triangles or is convex, alone or in a
    // compound; no ghost objects. A soft body whose nodes or faces change in number goes on as another body. Triangles
    // of rigid bodies are read in their first frame only. A body that Plugin::keepOnDevice() keeps must be fetched
    // before.
    void record();

    // Marks a node of the last frame as being in contact. Ignores bodies that are not in it, and nodes out of range.
    void markContact(const btSoftBody& body, int node);

    // Marks the nodes of the plugin's contacts that meet (gap ≤ 0). Call after record(). Takes a drape::Plugin.
    template <typename ContactSource>
    void addContacts(const ContactSource& plugin)
    {
        for (const auto& contact : plugin.contacts())
            for (int i = 0; i < 3 && contact.m_gap <= 0; ++i)
                if (contact.m_nodes[i] >= 0 && contact.m_weights[i] > 0)
                    markContact(*contact.m_cloth, contact.m_nodes[i]);
    }

    // Returns the frames so far. Title and remark are the caller's to set. Valid as long as the recorder.
    Recording& recording();
    // Returns the same to readers.
    const Recording& recording() const;

private:
    struct DRAPE_HIDDEN State;
    std::unique_ptr<State> m_state;
};
}  // namespace drape
