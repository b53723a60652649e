// The pairs that dispatch has noted, and the mirrors of their bodies and meshes.
#include <algorithm>

#include "BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h"
#include "BulletCollision/CollisionShapes/btCompoundShape.h"
#include "bullet_plugin/adapter/mirrors/mesh_reader.h"
#include "bullet_plugin/adapter/pairs/eligibility.h"
#include "bullet_plugin/adapter/pairs/margins.h"
#include "bullet_plugin/adapter/wiring/plugin_state.h"
#include "bullet_plugin/core/scene/growing_arrays.h"

namespace drape
{
namespace
{
// Number of steps for which a mirror without a pair is kept: two seconds at 60 steps a second.
constexpr std::uint64_t kKeepSteps = 120;

// Distinguishes a compound's children, through nested compounds.
std::uint64_t childOf(const btCollisionObjectWrapper& wrap)
{
    std::uint64_t child = 0;
    for (const btCollisionObjectWrapper* w = &wrap; w->m_parent; w = w->m_parent)
        child = child * 1099511628211ull + static_cast<std::uint64_t>(static_cast<std::int64_t>(w->m_index) + 2);
    return child;
}

// Returns the pose of the wrapped shape in its object.
btTransform placeOf(const btCollisionObjectWrapper& wrap)
{
    const btCollisionObjectWrapper* const parent = wrap.m_parent;
    if (!parent || !parent->getCollisionShape()->isCompound()) return btTransform::getIdentity();
    const auto& compound = static_cast<const btCompoundShape&>(*parent->getCollisionShape());
    return placeOf(*parent) * compound.getChildTransform(wrap.m_index);
}

// Checks whether objects still have the noted shapes. Actions and the tick's callback run between dispatch and solve,
// and may change an object's shape or a compound's children. Compares addresses.
class PresentShapes
{
public:
    bool has(const ObstacleKey& noted)
    {
        const btCollisionShape* root = noted.m_object->getCollisionShape();
        if (root == noted.m_shape) return true;
        if (!root || !root->isCompound()) return false;
        const auto found = m_children.emplace(noted.m_object, Shapes());
        if (found.second) addChildren(static_cast<const btCompoundShape&>(*root), found.first->second);
        return found.first->second.count(noted.m_shape) > 0;
    }

private:
    using Shapes = std::unordered_set<const btCollisionShape*>;

    static void addChildren(const btCompoundShape& compound, Shapes& shapes)
    {
        for (int i = 0; i < compound.getNumChildShapes(); ++i)
        {
            const btCollisionShape* child = compound.getChildShape(i);
            if (child->isCompound())
                addChildren(static_cast<const btCompoundShape&>(*child), shapes);
            else
                shapes.insert(child);
        }
    }

    std::unordered_map<const btCollisionObject*, Shapes> m_children;  // shapes inside compounds, nested ones included
};

// Counted among the mirror's owners.
template <typename Mirror>
void setPrepared(Mirror& mirror, bool prepared)
{
    mirror.m_owners += int(prepared) - int(mirror.m_prepared);
    mirror.m_prepared = prepared;
}

// No algorithm has it.
template <typename Mirror>
bool isUnpaired(const Mirror& mirror)
{
    return mirror.m_owners == int(mirror.m_prepared);
}

// Returns the motion of the object's shape, or of a compound's child, for that motion of the object.
BodyMotion motionOfShape(const btCollisionObjectWrapper& wrap, const BodyMotion& body)
{
    const btTransform& own = wrap.getCollisionObject()->getWorldTransform();
    const btTransform& pose = wrap.getWorldTransform();
    if (!body.moves() && body.m_end == own) return BodyMotion{pose, pose};
    const btTransform child = own.inverse() * pose;
    return BodyMotion{body.m_start * child, body.m_end == own ? pose : body.m_end * child};
}

// Returns the cloth's bounds, which cover its motion, with room for nodes that links pull off their paths.
SurfaceBox clothBox(const btSoftBody& cloth)
{
    SurfaceBox box = {cloth.m_bounds[0], cloth.m_bounds[1]};
    box.grow(box.slack());
    return box;
}

// Returns whether the obstacle is a plane that the cloth does not come near in the step. Bullet makes a pair of every
// plane and cloth of a world.
bool isFarSurface(const PairNote& note, const btCollisionShape& shape, btScalar activation)
{
    if (!isSurfaceShape(shape)) return false;
    const SurfaceBox cloth = clothBox(*note.m_cloth);
    const btScalar reach = note.m_thickness * (1 + activation);
    return !surfaceMeets(shape, note.m_motion.m_start, cloth, reach) &&
           !surfaceMeets(shape, note.m_motion.m_end, cloth, reach);
}
}  // namespace

void PluginState::note(const void* owner, btSoftBody& cloth, const btCollisionObjectWrapper& obstacle)
{
    PairNote note;
    note.m_owner = owner;
    note.m_solver = steppingSolver(cloth);
    note.m_cloth = &cloth;
    note.m_obstacle = ObstacleKey{obstacle.getCollisionObject(), obstacle.getCollisionShape(), childOf(obstacle)};
    btCollisionObject& object = *const_cast<btCollisionObject*>(obstacle.getCollisionObject());
    const btTransform& pose = obstacle.getWorldTransform();
    note.m_isMovable = mayMove(object);
    note.m_mover = object.isStaticOrKinematicObject() ? nullptr : &object;
    note.m_dynamic = note.m_mover ? btRigidBody::upcast(&object) : nullptr;
    note.m_yields = note.m_dynamic != nullptr;
    note.m_noted = object.getWorldTransform();
    note.m_velocity = note.m_dynamic ? note.m_dynamic->getLinearVelocity() : btVector3(0, 0, 0);
    note.m_place = placeOf(obstacle);
    note.m_motion = BodyMotion{pose, pose};
    if (object.isKinematicObject())
    {
        const BodyMotion body = motionsOf(note.m_solver).observe(object);
        note.m_noted = body.m_start;
        note.m_motion = motionOfShape(obstacle, body);
    }
    note.m_thickness = thicknessOf(cloth, *obstacle.getCollisionShape());
    if (isFarSurface(note, *obstacle.getCollisionShape(), btScalar(m_settings.m_activation))) return forgetNote(owner);
    const auto noted = m_noteOf.find(owner);
    if (noted != m_noteOf.end())
    {
        m_notes[noted->second] = note;
        return;
    }
    reserveGrowing(m_notes, m_notes.size() + 1);
    m_noteOf.emplace(owner, m_notes.size());
    m_notes.push_back(note);
}

// Allocates no memory: algorithms end, and with them their notes, even when memory is short.
template <class Drops>
void PluginState::dropNotesIf(const Drops& drops)
{
    std::size_t kept = 0;
    for (const PairNote& note : m_notes)
    {
        if (drops(note))
        {
            m_noteOf.erase(note.m_owner);
            continue;
        }
        m_noteOf.find(note.m_owner)->second = kept;
        m_notes[kept++] = note;
    }
    m_notes.erase(m_notes.begin() + static_cast<std::ptrdiff_t>(kept), m_notes.end());
}

void PluginState::forgetNote(const void* owner)
{
    if (m_noteOf.count(owner) > 0) dropNotesIf([owner](const PairNote& note) { return note.m_owner == owner; });
}

void PluginState::forget(const void* owner)
{
    forgetNote(owner);
    const auto found = m_owned.find(owner);
    if (found == m_owned.end()) return;
    disown(found->second);
    m_owned.erase(found);
}

void PluginState::disown(const Owned& owned)
{
    if (ClothMirror* cloth = findCloth(owned.m_cloth)) --cloth->m_owners;
    if (ObstacleMirror* obstacle = findObstacle(owned.m_obstacle)) --obstacle->m_owners;
}

bool PluginState::isOneSided(const btCollisionShape& shape) const
{
    return m_oneSided.count(&shape) + m_oneSided.count(meshShapeOf(shape)) > 0;
}

void PluginState::prepare(const btCollisionObject* const* objects, int count)
{
    if (!ready()) return;
    const ThreadWatch::Call call = beginCall();
    guarded([&] { prepareAll(objects, count); },
            [&](const CaughtException& caught) { fail("drape::Plugin::prepare", caught); });
}

void PluginState::prepareAll(const btCollisionObject* const* objects, int count)
{
    restart();
    m_found.keepList();  // by meshes as they are
    bool anyMeets = false;
    for (int i = 0; i < count; ++i)
    {
        if (!objects[i]) continue;
        const btCollisionObject& object = *objects[i];
        if (const btSoftBody* body = btSoftBody::upcast(&object))
        {
            prepareCloth(*body);
            anyMeets = anyMeets || m_selfCollision.find(*body);
        }
        else if (object.getCollisionShape())
            prepareShape({nullptr, object.getCollisionShape(), &object, object.getWorldTransform(), -1, -1});
    }
    if (anyMeets) m_pipeline->prepareSearch();
    m_pipeline->prepare();
    tellCompiled();
}

void PluginState::prepareCloth(const btSoftBody& body)
{
    ClothMirror& cloth = m_cloths.try_emplace(&body, &body).first->second;
    if (cloth.m_owners == 0) cloth.takeUp();
    setPrepared(cloth, true);
    cloth.refresh(*m_pipeline);
}

// Prepares the obstacle as resting in place.
void PluginState::prepareShape(const btCollisionObjectWrapper& wrap)
{
    const btCollisionShape& shape = *wrap.getCollisionShape();
    if (shape.isCompound())
    {
        const btCompoundShape& compound = static_cast<const btCompoundShape&>(shape);
        for (int i = 0; i < compound.getNumChildShapes(); ++i)
        {
            const btTransform place = wrap.getWorldTransform() * compound.getChildTransform(i);
            prepareShape({&wrap, compound.getChildShape(i), wrap.getCollisionObject(), place, -1, i});
        }
        return;
    }
    const btCollisionObject& object = *wrap.getCollisionObject();
    // Only the part of a surface near a cloth is read.
    if (!handlesObstacle(*this, object, shape) || isSurfaceShape(shape)) return;
    const ObstacleKey key = {&object, &shape, childOf(wrap)};
    ObstacleMirror& obstacle = m_obstacles.try_emplace(key, key).first->second;
    if (obstacle.m_owners == 0) obstacle.requireReading();
    setPrepared(obstacle, true);
    obstacle.beginStep(isOneSided(shape), triangleFilterOf(shape));
    obstacle.m_continued = false;
    obstacle.refresh(*m_pipeline, mayMove(object), BodyMotion{wrap.getWorldTransform(), wrap.getWorldTransform()});
}

void PluginState::release(const btCollisionObject* object)
{
    for (auto& entry : m_cloths)
        if (entry.first == object) setPrepared(entry.second, false);
    for (auto& entry : m_obstacles)
        if (entry.first.m_object == object) setPrepared(entry.second, false);
}

void PluginState::obstacleChanged(const btCollisionShape* shape)
{
    for (auto& entry : m_obstacles)
        if (entry.second.uses(shape)) entry.second.requireReading();
    // Wakes cloth that sleeps on it, so that the cloth follows the motion; its algorithm is alive, and so is the body.
    for (const auto& owned : m_owned)
    {
        const ObstacleMirror* obstacle = findObstacle(owned.second.m_obstacle);
        if (obstacle && obstacle->uses(shape)) const_cast<btSoftBody*>(owned.second.m_cloth)->activate();
    }
}

void PluginState::startAnew(const btCollisionObject* object)
{
    for (auto& entry : m_cloths)
        if (entry.first == object) entry.second.startAnew();
    for (auto& entry : m_obstacles)
        if (entry.first.m_object == object) entry.second.startAnew();
}

const ClothMirror* PluginState::mirrorOf(const btSoftBody& body) const
{
    const auto found = m_cloths.find(&body);
    return found == m_cloths.end() ? nullptr : &found->second;
}

void PluginState::bringToHost(btSoftBody& body)
{
    m_kept.bringToHost(body);
    ClothMirror* const mirror = findCloth(&body);
    if (mirror && m_kept.hadPair(body)) mirror->rememberEnds(threads(), &btSoftBody::Node::m_q);
}

void PluginState::teleported(const btCollisionObject* object)
{
    for (auto& motions : m_motions)
        motions.second.teleported(*object);
    for (auto& entry : m_obstacles)
        if (entry.first.m_object == object) entry.second.teleport();
    m_selfCollision.startAnew(*object);
    startAnew(object);
}

bool PluginState::movedAlong(const std::vector<btSoftBody*>& bodies, const btCollisionObject& object,
                             const btTransform& map, btScalar slack)
{
    return std::any_of(bodies.begin(), bodies.end(),
                       [&](const btSoftBody* body)
                       {
                           for (int i = 0; i < body->m_anchors.size(); ++i)
                               if (body->m_anchors[i].m_body == &object) return true;
                           const ClothMirror* const mirror = findCloth(body);
                           // Every solver's step counts, so that worlds which take turns are continued, too.
                           return mirror && mirror->m_lastSeen + m_solvers.size() > m_step &&
                                  mirror->movedAlong(map, slack);
                       });
}

void PluginState::setOneSided(const btCollisionShape* shape, bool oneSided)
{
    const auto set = [&]
    {
        if (oneSided && shape && !isReadable(*shape))
            tellNoEffect(*shape, "setOneSided", "meshes, planes, height fields and convex shapes, also in compounds");
        if (oneSided)
            m_oneSided.insert(shape);
        else
            m_oneSided.erase(shape);
    };
    guarded(set, [&](const CaughtException& caught) { fail("drape::Plugin::setOneSided", caught); });
}

void PluginState::setTriangleFilter(const btCollisionShape* shape, TriangleFilter filter)
{
    const auto set = [&]
    {
        if (filter && shape && !isMeshShape(*shape) && shape->getShapeType() != TERRAIN_SHAPE_PROXYTYPE)
            tellNoEffect(*shape, "setTriangleFilter", "meshes and height fields, also in compounds");
        if (filter)
            m_filters[shape] = std::move(filter);
        else
            m_filters.erase(shape);
    };
    guarded(set, [&](const CaughtException& caught) { fail("drape::Plugin::setTriangleFilter", caught); });
    obstacleChanged(shape);
}

const TriangleFilter* PluginState::triangleFilterOf(const btCollisionShape& shape) const
{
    auto found = m_filters.find(&shape);
    if (found == m_filters.end()) found = m_filters.find(meshShapeOf(shape));
    return found == m_filters.end() ? nullptr : &found->second;
}

void PluginState::dropNotes(const btSoftBodySolver* solver)
{
    dropNotesIf([solver](const PairNote& note) { return note.m_solver == solver; });
}

std::vector<PairNote> PluginState::takeNotes(const btSoftBodySolver* solver,
                                             const std::vector<const btSoftBody*>& cloths)
{
    std::vector<PairNote> taken;
    PresentShapes present;
    for (const PairNote& note : m_notes)
        if (note.m_solver == solver && std::binary_search(cloths.begin(), cloths.end(), note.m_cloth) &&
            present.has(note.m_obstacle))
            taken.push_back(note);
    dropNotes(solver);
    ++m_step;
    for (PairNote& note : taken)
    {
        adopt(note);
        settleMotion(note);
    }
    for (const PairNote& note : taken)
        if (!note.m_dynamic) obstacleMirror(note).setBodyEnd(note.m_obstacle.m_object->getWorldTransform());
    return taken;
}

// Completes the motion of a noted pair's obstacle, and tells a surface where the cloth is.
void PluginState::settleMotion(PairNote& note)
{
    ObstacleMirror& obstacle = obstacleMirror(note);
    const btTransform& body = note.m_obstacle.m_object->getWorldTransform();
    if (!note.m_mover && obstacle.countJump(body, note.m_motion.moves())) tellJumps(*note.m_obstacle.m_object);
    obstacle.place(note.m_place);
    note.m_movesPlace = obstacle.movesPlace();
    note.m_isMovable = note.m_isMovable || obstacle.movesInCompound();
    note.m_motion.m_start = obstacle.startOf(note.m_noted, note.m_motion.m_start, note.m_mover != nullptr);
    if (note.m_mover) note.endMotion();
    if (!isSurfaceShape(*note.m_obstacle.m_shape)) return;
    const SurfaceBox cloth = clothBox(*note.m_cloth);
    SurfaceBox seen = cloth.in(note.m_motion.m_end);
    seen.add(cloth.in(note.m_motion.m_start));
    obstacle.wantAround(seen);
}

// Makes the mirrors of a pair, and counts its algorithm among their owners.
void PluginState::adopt(const PairNote& note)
{
    ClothMirror& cloth = m_cloths.try_emplace(note.m_cloth, note.m_cloth).first->second;
    ObstacleMirror& obstacle = m_obstacles.try_emplace(note.m_obstacle, note.m_obstacle).first->second;
    // Every solver's step counts, so that worlds which take turns are continued, too.
    if (obstacle.m_lastSeen != m_step)
    {
        obstacle.m_continued = obstacle.m_lastSeen + m_solvers.size() >= m_step;
        obstacle.beginStep(isOneSided(*note.m_obstacle.m_shape), triangleFilterOf(*note.m_obstacle.m_shape));
    }
    cloth.m_lastSeen = obstacle.m_lastSeen = m_step;
    // Uses the cloth's current position, prepared or not: the trajectory depends on it.
    if (isUnpaired(cloth)) cloth.takeUp();
    if (obstacle.m_owners == 0) obstacle.requireReading();

    const auto found = m_owned.find(note.m_owner);
    if (found != m_owned.end())
    {
        if (found->second.m_cloth == note.m_cloth && found->second.m_obstacle == note.m_obstacle) return;
        disown(found->second);
    }
    m_owned[note.m_owner] = Owned{note.m_cloth, note.m_obstacle};
    ++cloth.m_owners;
    ++obstacle.m_owners;
}

ClothMirror* PluginState::findCloth(const btSoftBody* body)
{
    const auto found = m_cloths.find(body);
    return found == m_cloths.end() ? nullptr : &found->second;
}

ObstacleMirror* PluginState::findObstacle(const ObstacleKey& key)
{
    const auto found = m_obstacles.find(key);
    return found == m_obstacles.end() ? nullptr : &found->second;
}

ClothMirror& PluginState::clothMirror(const PairNote& note)
{
    return *findCloth(note.m_cloth);
}

ObstacleMirror& PluginState::obstacleMirror(const PairNote& note)
{
    return *findObstacle(note.m_obstacle);
}

template <typename Mirrors>
static void dropOld(Mirrors& mirrors, Pipeline& pipeline, std::uint64_t step)
{
    for (auto entry = mirrors.begin(); entry != mirrors.end();)
    {
        const auto& mirror = entry->second;
        if (mirror.m_owners > 0 || mirror.m_lastSeen + kKeepSteps > step)
        {
            ++entry;
            continue;
        }
        if (mirror.id() != kNoMesh) pipeline.remove(mirror.id());
        entry = mirrors.erase(entry);
    }
}

void PluginState::dropOldMirrors()
{
    dropOld(m_cloths, *m_pipeline, m_step);
    dropOld(m_obstacles, *m_pipeline, m_step);
}
}  // namespace drape
