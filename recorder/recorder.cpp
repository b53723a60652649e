#include "drape/recorder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "BulletCollision/CollisionDispatch/btCollisionWorld.h"
#include "BulletSoftBody/btSoftBody.h"
#include "recorder/node_gap.h"
#include "recorder/shape_triangles.h"

namespace drape
{
namespace
{
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr double kReachInMargins = 4;                   // up to which gaps are recorded, in margins of the soft body
constexpr double kLeastReach = 1e-3, kMostReach = 0.1;  // m
constexpr double kLeastThickness = 1e-4;                // m, of Drape's pairs
constexpr float kMostStretch = 10;                      // %, the high end of the scale

enum ChannelIndex
{
    kContact,
    kGap,
    kStretch
};

double reachOf(const btSoftBody& body)
{
    return std::clamp(kReachInMargins * double(body.getCollisionShape()->getMargin()), kLeastReach, kMostReach);
}

void appendVector(const btVector3& vector, std::vector<float>& out)
{
    for (int axis = 0; axis < 3; ++axis)
        out.push_back(float(vector[axis]));
}

// Returns the index of a node or face in its array.
template <typename Item>
int indexIn(const btAlignedObjectArray<Item>& array, const Item* item)
{
    return static_cast<int>(item - &array[0]);
}

// Takes the body's faces as triangles, and the links to nodes without a face as lines: ropes and fringes. Bending links
// would be chords beside a rope.
void readTopology(const btSoftBody& soft, RecordedBody& body)
{
    std::vector<bool> hasFace(static_cast<std::size_t>(soft.m_nodes.size()));
    for (int i = 0; i < soft.m_faces.size(); ++i)
        for (const btSoftBody::Node* node : soft.m_faces[i].m_n)
        {
            body.m_triangles.push_back(indexIn<btSoftBody::Node>(soft.m_nodes, node));
            hasFace[static_cast<std::size_t>(body.m_triangles.back())] = true;
        }
    for (int i = 0; i < soft.m_links.size(); ++i)
    {
        const int ends[2] = {indexIn<btSoftBody::Node>(soft.m_nodes, soft.m_links[i].m_n[0]),
                             indexIn<btSoftBody::Node>(soft.m_nodes, soft.m_links[i].m_n[1])};
        if (soft.m_links[i].m_bbending) continue;
        if (!hasFace[static_cast<std::size_t>(ends[0])] || !hasFace[static_cast<std::size_t>(ends[1])])
            body.m_lines.insert(body.m_lines.end(), ends, ends + 2);
    }
}

void appendStretch(const btSoftBody& soft, std::vector<float>& values)
{
    const std::size_t first = values.size();
    values.resize(first + static_cast<std::size_t>(soft.m_nodes.size()), kNone);
    for (int i = 0; i < soft.m_links.size(); ++i)
    {
        const btSoftBody::Link& link = soft.m_links[i];
        if (!(link.m_rl > 0)) continue;
        const auto share = float(100 * ((link.m_n[1]->m_x - link.m_n[0]->m_x).length() / link.m_rl - 1));
        for (const btSoftBody::Node* node : link.m_n)
        {
            float& value = values[first + static_cast<std::size_t>(indexIn<btSoftBody::Node>(soft.m_nodes, node))];
            value = std::fmax(value, share);  // a NaN gives way
        }
    }
}

void appendContacts(const btSoftBody& soft, std::vector<float>& values)
{
    const std::size_t first = values.size();
    values.resize(first + static_cast<std::size_t>(soft.m_nodes.size()));
    const auto mark = [&](const btSoftBody::Node* node)
    {
        const int index = indexIn<btSoftBody::Node>(soft.m_nodes, node);
        if (index >= 0 && index < soft.m_nodes.size()) values[first + static_cast<std::size_t>(index)] = 1;
    };
    for (int i = 0; i < soft.m_rcontacts.size(); ++i)
        mark(soft.m_rcontacts[i].m_node);
    for (int i = 0; i < soft.m_scontacts.size(); ++i)
        mark(soft.m_scontacts[i].m_node);
}

bool isGhost(const btCollisionObject& object)
{
    return object.getInternalType() == btCollisionObject::CO_GHOST_OBJECT;
}
}  // namespace

struct Recorder::State
{
    struct Source
    {
        std::size_t m_body;   // its index in the recording
        std::size_t m_frame;  // the recording's last frame with the object
        const btCollisionShape* m_shape;
        bool m_closed;
    };

    const btCollisionWorld& m_world;
    RecorderSettings m_settings;
    Recording m_recording;
    std::unordered_map<const btCollisionObject*, Source> m_sources;
    std::vector<GapObstacle> m_obstacles;  // filled anew for each frame

    RecordedBody& add(const btCollisionObject& object, const char* kind, Source& source)
    {
        RecordedBody body;
        body.m_name = kind + std::to_string(m_recording.m_bodies.size() + 1);
        body.m_first = m_recording.m_frameCount;
        source = {m_recording.m_bodies.size(), body.m_first, object.getCollisionShape(), false};
        m_recording.m_bodies.push_back(std::move(body));
        return m_recording.m_bodies.back();
    }

    // Returns the object's record, which `make` fills if it is new, or no longer `fits`.
    template <typename Fits, typename Make>
    RecordedBody& bodyOf(const btCollisionObject& object, const Fits& fits, const Make& make)
    {
        const auto found = m_sources.find(&object);
        const bool known = found != m_sources.end() && found->second.m_frame + 1 == m_recording.m_frameCount &&
                           fits(m_recording.m_bodies[found->second.m_body], found->second);
        Source& source = m_sources[&object];
        if (!known) make(source);
        source.m_frame = m_recording.m_frameCount;
        return m_recording.m_bodies[source.m_body];
    }

    void recordRigid(const btCollisionObject& object)
    {
        RecordedBody& body = bodyOf(
            object,
            [&](const RecordedBody& known, const Source& source)
            { return known.m_rigid && source.m_shape == object.getCollisionShape(); },
            [&](Source& source)
            {
                ShapeTriangles triangles = trianglesOf(*object.getCollisionShape());
                RecordedBody& made = add(object, "body ", source);
                source.m_closed = m_settings.m_gaps && triangles.closed();
                made.m_rigid = true;
                made.m_vertices = std::move(triangles.m_vertices);
                made.m_triangles = std::move(triangles.m_triangles);
            });
        const btTransform& pose = object.getWorldTransform();
        appendVector(pose.getOrigin(), body.m_frames);
        const btQuaternion turn = pose.getRotation();
        appendVector(btVector3(turn.x(), turn.y(), turn.z()), body.m_frames);
        body.m_frames.push_back(float(turn.w()));
        if (m_settings.m_gaps && hasGaps(*object.getCollisionShape()))
            m_obstacles.push_back({&object, m_sources[&object].m_closed});
    }

    void addSoft(const btSoftBody& soft, Source& source)
    {
        RecordedBody& body = add(soft, "cloth ", source);
        readTopology(soft, body);
        for (int i = 0; i < soft.m_nodes.size(); ++i)
            appendVector(soft.m_nodes[i].m_x, body.m_vertices);
        const auto reach = float(1000 * reachOf(soft));
        body.m_channels.resize(3);
        body.m_channels[kContact].m_name = "contact";
        body.m_channels[kGap] = {"gap", "mm", -reach, reach, {}};
        body.m_channels[kStretch] = {"stretch", "%", 0, kMostStretch, {}};
    }

    void recordSoft(const btSoftBody& soft)
    {
        RecordedBody& body = bodyOf(
            soft,
            [&](const RecordedBody& known, const Source&)
            {
                return !known.m_rigid && known.vertexCount() == static_cast<std::size_t>(soft.m_nodes.size()) &&
                       known.m_triangles.size() == 3 * static_cast<std::size_t>(soft.m_faces.size());
            },
            [&](Source& source) { addSoft(soft, source); });
        for (int i = 0; i < soft.m_nodes.size(); ++i)
            appendVector(soft.m_nodes[i].m_x, body.m_frames);
        appendContacts(soft, body.m_channels[kContact].m_values);
        appendGaps(soft, body.m_channels[kGap].m_values);
        appendStretch(soft, body.m_channels[kStretch].m_values);
    }

    void appendGaps(const btSoftBody& soft, std::vector<float>& values) const
    {
        const std::size_t first = values.size();
        values.resize(first + static_cast<std::size_t>(soft.m_nodes.size()), kNone);
        const double reach = reachOf(soft), own = double(soft.getCollisionShape()->getMargin());
        for (const GapObstacle& obstacle : m_obstacles)
        {
            const btCollisionShape& shape = *obstacle.m_object->getCollisionShape();
            const double thickness = std::max(own + double(shape.getMargin()), kLeastThickness);
            const auto around = static_cast<btScalar>(reach + thickness);
            btVector3 low, high;
            shape.getAabb(obstacle.m_object->getWorldTransform(), low, high);
            low -= btVector3(around, around, around);
            high += btVector3(around, around, around);
            for (int i = 0; i < soft.m_nodes.size(); ++i)
            {
                const btVector3& node = soft.m_nodes[i].m_x;
                btVector3 inside = node;
                inside.setMax(low);
                inside.setMin(high);
                if (!(inside == node)) continue;
                const double gap = distanceTo(obstacle, node, double(around)) - thickness;
                float& value = values[first + static_cast<std::size_t>(i)];
                if (gap <= reach) value = std::fmin(value, float(1000 * gap));  // a NaN gives way
            }
        }
    }
};

Recorder::Recorder(const btCollisionWorld& world, const RecorderSettings& settings)
    : m_state(new State{world, settings, {}, {}, {}})
{
    m_state->m_recording.m_frameTime = settings.m_frameTime;
}

Recorder::~Recorder() = default;

void Recorder::record()
{
    State& state = *m_state;
    const btCollisionObjectArray& objects = state.m_world.getCollisionObjectArray();
    state.m_obstacles.clear();
    for (int i = 0; i < objects.size(); ++i)
        if (!btSoftBody::upcast(objects[i]) && !isGhost(*objects[i])) state.recordRigid(*objects[i]);
    for (int i = 0; i < objects.size(); ++i)
    {
        const btSoftBody* soft = btSoftBody::upcast(objects[i]);
        if (!soft) continue;
        state.recordSoft(*soft);
        const btVector3& gravity = soft->m_worldInfo->m_gravity;
        for (int axis = 0; axis < 3 && gravity.length2() > 0; ++axis)
            state.m_recording.m_up[axis] = float(-gravity.normalized()[axis]);
    }
    ++state.m_recording.m_frameCount;
}

void Recorder::markContact(const btSoftBody& body, int node)
{
    const auto found = m_state->m_sources.find(&body);
    if (found == m_state->m_sources.end() || found->second.m_frame + 1 != m_state->m_recording.m_frameCount) return;
    RecordedBody& recorded = m_state->m_recording.m_bodies[found->second.m_body];
    const std::size_t count = recorded.vertexCount();
    if (node < 0 || static_cast<std::size_t>(node) >= count) return;
    std::vector<float>& values = recorded.m_channels[kContact].m_values;
    values[values.size() - count + static_cast<std::size_t>(node)] = 1;
}

Recording& Recorder::recording()
{
    return m_state->m_recording;
}

const Recording& Recorder::recording() const
{
    return m_state->m_recording;
}
}  // namespace drape
