#include "bullet_plugin/adapter/collision/collision_step.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "bullet_plugin/adapter/collision/stretch.h"
#include "bullet_plugin/adapter/solver/body_nodes.h"
#include "bullet_plugin/core/scene/growing_arrays.h"
#include "bullet_plugin/core/stopwatch.h"

namespace drape
{
namespace
{
// Returns whether an obstacle goes twice its size (m) in a step, or turns by more than a right angle.
bool jumps(const BodyMotion& motion, btScalar size)
{
    const btMatrix3x3 turn = motion.m_end.getBasis() * motion.m_start.getBasis().transpose();
    return (motion.m_end.getOrigin() - motion.m_start.getOrigin()).length() > 2 * size ||
           turn[0][0] + turn[1][1] + turn[2][2] < 1;
}

// Returns the bounds of the obstacle at the motion's end, m: of a plane near the cloth.
SurfaceBox boundsOf(const PairNote& note)
{
    const btCollisionShape& shape = *note.m_obstacle.m_shape;
    SurfaceBox bounds = {note.m_cloth->m_bounds[0], note.m_cloth->m_bounds[1]};
    bounds.grow(bounds.m_high - bounds.m_low);
    if (isSurfaceShape(shape)) return surfaceBounds(shape, note.m_motion.m_end, bounds);
    shape.getAabb(note.m_motion.m_end, bounds.m_low, bounds.m_high);
    return bounds;
}

// Returns whether contacts could move any of the body's nodes.
bool anyMoves(const btSoftBody& body)
{
    if (!(body.m_sst.sdt > 0)) return false;
    for (int i = 0; i < body.m_nodes.size(); ++i)
        if (movableInverseMass(body.m_nodes[i]) > 0) return true;
    return false;
}

// startOf: returns a node's start by its index, m.
template <class StartOf>
void writeNodes(const btSoftBody& body, const StartOf& startOf, const NodeStretch& stretch)
{
    float *start = stretch.m_start, *end = stretch.m_end;
    for (std::size_t i = stretch.m_first; i < stretch.m_first + stretch.m_count; ++i)
    {
        writePosition(startOf(i), start);
        writePosition(body.m_nodes[static_cast<int>(i)].m_x, end);
    }
}
}  // namespace

BodyContacts* CollisionStep::bodyOf(MeshId cloth)
{
    const auto found = m_byCloth.find(cloth);
    return found == m_byCloth.end() ? nullptr : &m_bodies[found->second];
}

BodyContacts* CollisionStep::contactsOf(const btSoftBody& body)
{
    const auto found = m_byBody.find(&body);
    return found == m_byBody.end() ? nullptr : &m_bodies[found->second];
}

void CollisionStep::watch(const btSoftBody& body)
{
    const auto found = m_byBody.find(&body);
    if (found != m_byBody.end()) m_mirrors[found->second]->watch(true);
}

void CollisionStep::addBody(ClothMirror& cloth, btSoftBody* body)
{
    // Reserves room for all, so that clear() allocates no memory.
    reserveGrowing(m_spare, m_bodies.size() + m_spare.size() + 1);
    if (m_spare.empty()) m_spare.emplace_back();
    m_bodies.push_back(std::move(m_spare.back()));
    m_spare.pop_back();
    m_byCloth[cloth.id()] = m_byBody[body] = m_bodies.size() - 1;
    m_uploads.push_back(Upload{cloth.id(), m_bodies.size() - 1, nullptr});
    m_bodies.back().start(cloth.id(), body, cloth.parts(), cloth.order());
    m_bodies.back().m_isOnDevice = m_state.m_kept.stepOf(*body) != nullptr;
}

void CollisionStep::clear()
{
    std::move(m_bodies.begin(), m_bodies.end(), std::back_inserter(m_spare));
    m_bodies.clear();
    m_byCloth.clear();
    m_byBody.clear();
    m_pairs.clear();
    m_dynamic.clear();
    m_paired.clear();
    m_pinned.clear();
    m_mirrors.clear();
    m_uploads.clear();
}

void CollisionStep::giveBackRoom()
{
    clear();
    m_bodies = std::vector<BodyContacts>();
    m_spare = std::vector<BodyContacts>();
    m_jumped = std::vector<std::vector<int>>();
    m_pairs = std::vector<Pair>();
    m_uploads = std::vector<Upload>();
}

// Makes the pipeline's pair. Beside an obstacle whose vertices move in this step, the cloth has a mesh and starts of
// its own.
CollisionStep::Pair CollisionStep::makePair(const PairNote& note, const ClothMirror& cloth, MeshId obstacle)
{
    const ObstacleMirror& mirror = m_state.obstacleMirror(note);
    Pair pair = {cloth.id(), obstacle, nullptr, {&cloth, &mirror, note.m_motion, note.m_isMovable}, note};
    if (!mirror.before()) return pair;
    bringToHost(*bodyOf(cloth.id()));
    const btScalar reach = note.m_thickness * (1 + btScalar(m_state.settings().m_activation));
    const DeformedPair& deformed = m_deformed.update(cloth, mirror, note.m_motion, note.m_isMovable, reach);
    const std::size_t body = m_byCloth.at(cloth.id());
    m_bodies[body].m_hasDeformedPair = true;
    m_byCloth[deformed.m_mesh] = body;
    m_uploads.push_back(Upload{deformed.m_mesh, body, deformed.m_starts.data()});
    m_state.m_found.nameCloth(deformed.m_mesh, note.m_cloth);
    m_state.m_found.source().nameStarts(deformed.m_mesh, deformed.m_carried.data());
    pair.m_cloth = deformed.m_mesh;
    pair.m_carriedStarts = deformed.m_carried.data();
    return pair;
}

// Reports a cloth that covers more cells of a height field than a step reads. It does not collide with the field.
void CollisionStep::leaveOutField(const PairNote& note)
{
    m_fieldsLeftOut = true;
    if (!m_toldFields.isNew({keyOf(*note.m_cloth), keyOf(*note.m_obstacle.m_object)})) return;
    m_state.log(m_state.nameOf(*note.m_cloth) + " covers more cells of the height field of " +
                m_state.nameOf(*note.m_obstacle.m_object) +
                " than a step reads, and does not collide with it in this step");
}

void CollisionStep::addPair(const PairNote& note)
{
    ClothMirror& cloth = m_state.clothMirror(note);
    const auto bringToHost = [&]
    {
        if (m_state.m_kept.stepOf(*note.m_cloth)) m_bringToHost(*note.m_cloth);
    };
    const MeshId clothId = bodyOf(cloth.id()) ? cloth.id() : cloth.refresh(m_state.pipeline(), bringToHost);
    ObstacleMirror& obstacle = m_state.obstacleMirror(note);
    const MeshId obstacleId = obstacle.refresh(m_state.pipeline(), note.m_isMovable, note.m_motion);
    if (obstacle.isTooLarge()) leaveOutField(note);
    if (clothId == kNoMesh || obstacleId == kNoMesh) return;
    if (!bodyOf(clothId))
    {
        addBody(cloth, note.m_cloth);
        m_mirrors.push_back(&cloth);
        m_state.m_found.nameCloth(clothId, note.m_cloth);
    }
    m_state.m_found.nameObstacle(obstacle, note.m_motion);
    if (!m_paired.insert(std::uint64_t(clothId) << 32 | obstacleId).second) return;
    m_pairs.push_back(makePair(note, cloth, obstacleId));
    m_state.m_found.namePair({note.m_cloth, obstacleId, float(note.m_thickness)});
    const SurfaceBox bounds = boundsOf(note);
    btVector3 low = bounds.m_low, high = bounds.m_high;
    // Accounts for a negative margin: it makes Bullet's box smaller than the mesh, by up to √3 times the margin when
    // turned.
    const btScalar lacks = btScalar(1.7321) * std::max(btScalar(0), -note.m_obstacle.m_shape->getMargin());
    low -= btVector3(lacks, lacks, lacks);
    high += btVector3(lacks, lacks, lacks);
    BodyContacts& body = *bodyOf(clothId);
    body.m_obstacleJumps = body.m_obstacleJumps || jumps(note.m_motion, (high - low).length());
    ClothContacts& contacts = body.m_contacts;
    const float thickness = float(note.m_thickness);
    if (note.m_dynamic && note.m_yields)
        addDynamic(body, obstacleId, note);
    else
    {
        contacts.m_limit.addObstacle(vec3Of(low), vec3Of(high), thickness, m_state.settings().m_activation,
                                     {m_state.m_found.source().mapOf(obstacleId), m_pairs.back().m_carriedStarts});
        contacts.m_obstacles.push_back({obstacleId, thickness});
    }
    contacts.m_leastThickness = std::min(contacts.m_leastThickness, thickness);
    contacts.m_mostThickness = std::max(contacts.m_mostThickness, thickness);
}

// A dynamic obstacle may yield, so that it has no motion yet that could limit the cloth's: the real paths are checked
// instead (followDynamic()).
void CollisionStep::addDynamic(BodyContacts& body, MeshId obstacle, const PairNote& note)
{
    m_dynamic[obstacle] = {note.m_dynamic, note.m_velocity, note.m_noted.getOrigin()};
    body.m_hasDynamicPair = body.m_contacts.m_isFiltered = true;
    bringToHost(body);
}

// Records the paths of the nodes and writes them for the device, so that a large cloth's nodes are read once. Later
// detections of a step keep the paths' starts.
void CollisionStep::uploadNodes(Detection detection)
{
    std::vector<MeshId> cloths;
    std::vector<const Upload*> uploads;
    for (const Upload& upload : m_uploads)
    {
        const BodyContacts& body = m_bodies[upload.m_body];
        if (detection != Detection::First && !isDetected(body, detection)) continue;
        if (body.m_isOnDevice)
            m_state.pipeline().addKept(upload.m_mesh, *m_state.m_kept.stepOf(*body.m_body));
        else
        {
            cloths.push_back(upload.m_mesh);
            uploads.push_back(&upload);
        }
        if (upload.m_starts) continue;
        ClothContacts& contacts = m_bodies[upload.m_body].m_contacts;
        contacts.m_limit.startStep(m_mirrors[upload.m_body]->faces());
        contacts.m_nodes.resize(m_mirrors[upload.m_body]->faces().nodeCount());
    }
    const auto write = [&](const NodeStretch& stretch)
    {
        const Upload& upload = *uploads[stretch.m_cloth];
        BodyContacts& body = m_bodies[upload.m_body];
        if (upload.m_starts)
            return writeNodes(
                *body.m_body, [&](std::size_t node) { return upload.m_starts[node]; }, stretch);
        for (std::size_t i = stretch.m_first; i < stretch.m_first + stretch.m_count; ++i)
        {
            const btSoftBody::Node& node = body.m_body->m_nodes[int(i)];
            if (detection == Detection::First)
                recordPath(node, i, body.nodes());
            else
                recordEnd(node, i, body.nodes());
        }
        writeNodes(
            *body.m_body, [&](std::size_t node) { return vectorOf(body.nodes().start(node)); }, stretch);
    };
    m_state.pipeline().writeNodes(cloths, write);
}

// Records the body's paths again as the detection found them, on the host: the solver may have replaced their ends by
// more precise ones.
void CollisionStep::recordPaths(BodyContacts& body)
{
    bringToHost(body);
    for (std::size_t i = 0; i < body.nodes().count(); ++i)
        recordPath(body.m_body->m_nodes[static_cast<int>(i)], i, body.nodes());
}

void CollisionStep::bringToHost(BodyContacts& body)
{
    if (!body.m_isOnDevice) return;
    m_bringToHost(*body.m_body);
    body.m_isOnDevice = false;
}

void CollisionStep::begin(const std::vector<PairNote>& notes, BringToHost bringToHost)
{
    const auto neededHost = [](const BodyContacts& body) { return body.m_meetsSurface; };
    const auto count = std::count_if(m_bodies.begin(), m_bodies.end(), neededHost);
    m_neededHost = 2 * static_cast<std::size_t>(count) > m_bodies.size();
    clear();
    m_bringToHost = std::move(bringToHost);
    m_uploadMs = 0;
    m_fieldsLeftOut = false;
    m_state.m_found.clear();
    // Adding and removing meshes moves the memory that nodes are written to: mirrors first, nodes after.
    m_state.dropOldMirrors();
    m_deformed.beginStep();
    for (const PairNote& note : notes)
    {
        if (anyMoves(*note.m_cloth) || (note.m_dynamic && note.m_yields))
            addPair(note);
        else if (std::find(m_pinned.begin(), m_pinned.end(), note.m_cloth) == m_pinned.end())
            m_pinned.push_back(note.m_cloth);
    }
    checkStarts();
}

void CollisionStep::submit(ContactPlace place)
{
    if (m_pairs.empty()) return;
    namePairs(Detection::First);
    if (!m_state.pipeline().mayStay()) place = ContactPlace::Host;
    for (BodyContacts& body : m_bodies)
        if (place == ContactPlace::Host) bringToHost(body);
    submit(Detection::First, place);
    m_state.m_found.setOnDevice(m_state.pipeline(), m_state.pipeline().contactsOnDevice());
}

// Returns whether the body takes part in a detection: in the first one, in others until it is solved, and in checks if
// it left its path.
bool CollisionStep::isDetected(const BodyContacts& body, Detection detection) const
{
    if (body.m_leftOut) return false;
    if (detection == Detection::Check) return body.m_isOffPath;
    return detection == Detection::First || !body.m_contacts.m_isSolved;
}

// Names the pairs of the coming detection.
void CollisionStep::namePairs(Detection detection)
{
    for (const Pair& pair : m_pairs)
    {
        if (!isDetected(*bodyOf(pair.m_cloth), detection)) continue;
        m_state.pipeline().addPair(pair.m_cloth, pair.m_obstacle, static_cast<float>(pair.m_note.m_thickness));
    }
}

void CollisionStep::submit(Detection detection, ContactPlace place)
{
    Stopwatch watch;
    uploadNodes(detection);
    m_state.pipeline().submit(place);
    m_uploadMs += watch.lapMs();
}
}  // namespace drape
