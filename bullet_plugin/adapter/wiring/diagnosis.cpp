#include "bullet_plugin/adapter/wiring/diagnosis.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "BulletCollision/CollisionDispatch/btCollisionWorld.h"
#include "BulletCollision/CollisionShapes/btCompoundShape.h"
#include "bullet_plugin/adapter/mirrors/mesh_reader.h"
#include "bullet_plugin/adapter/mirrors/solid_links.h"
#include "bullet_plugin/adapter/pairs/eligibility.h"
#include "bullet_plugin/adapter/pairs/margins.h"
#include "bullet_plugin/adapter/wiring/log_text.h"
#include "bullet_plugin/adapter/wiring/plugin_state.h"
#include "bullet_plugin/adapter/wiring/wiring.h"
#include "bullet_plugin/core/probe/mesh_probe.h"
#include "kernels/lib/geometry/vec3.h"

namespace drape
{
namespace
{
bool mayCollide(const btCollisionObject& a, const btCollisionObject& b)
{
    const btBroadphaseProxy *const p = a.getBroadphaseHandle(), *const q = b.getBroadphaseHandle();
    return p && q && (p->m_collisionFilterGroup & q->m_collisionFilterMask) &&
           (q->m_collisionFilterGroup & p->m_collisionFilterMask);
}

SolidLinks solidLinksOf(const btSoftBody& cloth)
{
    std::vector<std::int32_t> faces;
    for (int f = 0; f < cloth.m_faces.size(); ++f)
        for (const btSoftBody::Node* node : cloth.m_faces[f].m_n)
            faces.push_back(nodeIndex(cloth, node));
    SolidLinks links;
    links.read(cloth, faces);
    return links;
}

class Diagnosis
{
public:
    Diagnosis(const Plugin& plugin, const btCollisionWorld& world) : m_plugin(plugin), m_world(world) {}

    std::string text()
    {
        addSetup();
        const btCollisionObjectArray& objects = m_world.getCollisionObjectArray();
        for (int i = 0; i < objects.size(); ++i)
        {
            btSoftBody* const cloth = btSoftBody::upcast(objects[i]);
            if (!cloth)
            {
                addAbout(*objects[i], m_plugin.state()->jumpRemark(*objects[i]));
                continue;
            }
            m_plugin.state()->m_kept.fetch(*cloth);
            addCloth(*cloth);
        }
        addClothPairs();
        const std::string status = statusText(m_plugin.statistics().m_status);
        if (!status.empty()) add("the last step: " + status);
        return lines();
    }

private:
    // Identifies a body (the second is null) or a pair of bodies.
    using Subject = std::pair<const btCollisionObject*, const btCollisionObject*>;

    // Holds a text and the bodies or pairs to which it applies; none if it is about the whole world.
    struct Remark
    {
        std::string m_text, m_firstName;
        std::set<Subject> m_subjects;

        // Returns the line, which names one body or pair and counts the others.
        std::string line() const
        {
            if (m_subjects.empty()) return m_text;
            const std::size_t others = m_subjects.size() - 1;
            const bool isPair = m_subjects.begin()->second != nullptr;
            const char* const what = isPair ? (others == 1 ? " more pair)" : " more pairs)")
                                            : (others == 1 ? " more body)" : " more bodies)");
            return m_firstName + (others == 0 ? "" : " (and " + std::to_string(others) + what) + ": " + m_text;
        }
    };

    void add(const std::string& line) { m_remarks.push_back({line, "", {}}); }
    // Adds a remark about a body, unless it is empty.
    void addAbout(const btCollisionObject& body, const std::string& remark)
    {
        addAbout({&body, nullptr}, remark, [&] { return m_plugin.state()->nameOf(body); });
    }
    // Adds a remark about a pair, unless it is empty.
    void addAbout(const btCollisionObject& a, const btCollisionObject& b, const std::string& remark)
    {
        addAbout({&a, &b}, remark, [&] { return m_plugin.state()->namesOf(a, b); });
    }
    template <class MakeName>
    void addAbout(const Subject& subject, const std::string& remark, const MakeName& makeName)
    {
        if (remark.empty()) return;
        const auto [place, isNew] = m_places.emplace(remark, m_remarks.size());
        if (isNew) m_remarks.push_back({remark, makeName(), {}});
        m_remarks[place->second].m_subjects.insert(subject);
    }
    std::string lines() const;
    void addSetup();
    void addLinks(const btSoftBody& cloth);
    void addClothPairs();
    void addCloth(const btSoftBody& cloth);
    void addPair(const btSoftBody& cloth, const btCollisionObject& object, const btCollisionShape& shape,
                 const btTransform& pose);
    void addIntersections(const btSoftBody& cloth, const btCollisionObject& object, const btCollisionShape& shape,
                          const btTransform& pose);
    std::unique_ptr<MeshProbe> makeProbe(const btCollisionShape& shape, const ReadPart& part) const;
    MeshProbe* probeOf(const btCollisionShape& shape);

    const Plugin& m_plugin;
    const btCollisionWorld& m_world;
    std::vector<Remark> m_remarks;
    std::map<std::string, std::size_t> m_places;  // indices of the remarks about bodies, by text
    std::map<const btCollisionShape*, std::unique_ptr<MeshProbe>> m_probes;
};

std::string Diagnosis::lines() const
{
    std::string all;
    for (const Remark& remark : m_remarks)
        all += (all.empty() ? "" : "\n") + remark.line();
    return all;
}

void Diagnosis::addSetup()
{
    if (!m_plugin.ready()) return add("Drape is off: " + m_plugin.error());
    if (!m_plugin.error().empty()) add(m_plugin.error());
    btDispatcher* const dispatcher = const_cast<btDispatcher*>(m_world.getDispatcher());
    if (!dispatcher || pluginOf(*dispatcher) != m_plugin.state().get())
        add("the world's dispatcher does not have Drape's algorithm: make it with a drape::CollisionConfiguration of "
            "this plugin, or call drape::install()");
}

// A body that the settings, or Bullet in double precision, leave to Bullet is no problem of the world.
void Diagnosis::addLinks(const btSoftBody& cloth)
{
    PluginState& state = *m_plugin.state();
    if (!state.ready() || state.settings().m_solver == Solver::Bullet || sizeof(btScalar) != sizeof(float)) return;
    if (!state.ownsSolver(cloth.getSoftBodySolver())) return;
    const char* const reason = reasonForBulletsLinks(state, cloth);
    if (reason) addAbout(cloth, std::string("Bullet solves its links, so that it stretches more: ") + reason);
}

// Adds what the last step found of cloth with cloth, as far as the bodies are in this world.
void Diagnosis::addClothPairs()
{
    std::map<std::pair<const btSoftBody*, const btSoftBody*>, ClothPairCounts> met;
    for (const FlaggedPair& pair : m_plugin.state()->m_flagged)
        if (pair.m_otherBody) met[std::minmax(pair.m_body, pair.m_otherBody)].add(pair.m_flag);
    const btCollisionObjectArray& objects = m_world.getCollisionObjectArray();
    const auto isHere = [&](const btSoftBody* body)
    {
        for (int i = 0; i < objects.size(); ++i)
            if (objects[i] == body) return true;
        return false;
    };
    for (const auto& [bodies, counts] : met)
        if (isHere(bodies.first) && isHere(bodies.second)) addAbout(*bodies.first, *bodies.second, counts.text());
}

void Diagnosis::addCloth(const btSoftBody& cloth)
{
    addLinks(cloth);
    const SelfColliding* const self = m_plugin.state()->m_selfCollision.find(cloth);
    if (self) addAbout(cloth, selfThicknessRemark(cloth, SelfCollision::thicknessOf(cloth, *self)));
    if (!m_plugin.state()->ownsSolver(cloth.getSoftBodySolver()))
        addAbout(cloth, "the world's soft body solver is not a drape::SoftBodySolver of this plugin");
    int invalid = 0;
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        invalid += !std::isfinite(cloth.m_nodes[i].m_x.length2());
    if (invalid > 0)
        addAbout(cloth, std::to_string(invalid) + (invalid == 1 ? " node is not finite" : " nodes are not finite"));
    std::map<std::string, int> reasons;
    const btCollisionObjectArray& objects = m_world.getCollisionObjectArray();
    for (int i = 0; i < objects.size(); ++i)
    {
        const btCollisionObject& object = *objects[i];
        if (btSoftBody::upcast(&object) || !object.getCollisionShape() || !mayCollide(cloth, object)) continue;
        const std::string reason = m_plugin.whyStock(&cloth, &object);
        if (!reason.empty()) ++reasons[reason];
        addPair(cloth, object, *object.getCollisionShape(), object.getWorldTransform());
    }
    for (const auto& [reason, count] : reasons)
        addAbout(cloth, "Bullet's own collision handles pairs with " + std::to_string(count) +
                            (count == 1 ? " object: " : " objects: ") + reason);
}

// The leaves of the object's shape that Drape handles.
void Diagnosis::addPair(const btSoftBody& cloth, const btCollisionObject& object, const btCollisionShape& shape,
                        const btTransform& pose)
{
    if (shape.isCompound())
    {
        const btCompoundShape& compound = static_cast<const btCompoundShape&>(shape);
        for (int i = 0; i < compound.getNumChildShapes(); ++i)
            addPair(cloth, object, *compound.getChildShape(i), pose * compound.getChildTransform(i));
        return;
    }
    if (reasonForStock(*m_plugin.state(), cloth, object, shape)) return;
    addAbout(cloth, object, marginRemark(cloth, shape));
    addIntersections(cloth, object, shape, pose);
}

// Returns null for a mesh without triangles.
std::unique_ptr<MeshProbe> Diagnosis::makeProbe(const btCollisionShape& shape, const ReadPart& part) const
{
    WorldMesh mesh;
    readMesh(shape, btTransform::getIdentity(), part, mesh);
    if (mesh.m_triangles.empty()) return nullptr;
    MeshDescription description;
    description.m_triangles = mesh.m_triangles.data();
    description.m_triangleCount = mesh.m_triangles.size() / 3;
    description.m_positions = mesh.m_positions.data();
    description.m_vertexCount = mesh.m_positions.size() / 3;
    return std::make_unique<MeshProbe>(description);
}

MeshProbe* Diagnosis::probeOf(const btCollisionShape& shape)
{
    std::unique_ptr<MeshProbe>& probe = m_probes[&shape];
    if (!probe) probe = makeProbe(shape, {{}, m_plugin.state()->triangleFilterOf(shape)});
    return probe.get();
}

// Checks the two at their current positions, where the next step begins.
void Diagnosis::addIntersections(const btSoftBody& cloth, const btCollisionObject& object,
                                 const btCollisionShape& shape, const btTransform& pose)
{
    std::unique_ptr<MeshProbe> surface;
    if (isSurfaceShape(shape))
    {
        const SurfaceBox bounds = {cloth.m_bounds[0], cloth.m_bounds[1]};
        const ReadPart part = {{bounds.in(pose)}, m_plugin.state()->triangleFilterOf(shape)};
        if (isSurfaceReadable(shape, part.m_boxes)) surface = makeProbe(shape, part);
    }
    MeshProbe* const probe = isSurfaceShape(shape) ? surface.get() : probeOf(shape);
    if (!probe) return;
    const auto placeOf = [&](const btSoftBody::Node& node)
    {
        const btVector3 seen = pose.inverse() * node.m_x;
        return vec3(float(seen.x()), float(seen.y()), float(seen.z()));
    };
    std::size_t pairs = 0, inside = 0;
    std::vector<std::uint32_t> meeting;
    for (int f = 0; f < cloth.m_faces.size(); ++f)
    {
        const Vec3 corners[3] = {placeOf(*cloth.m_faces[f].m_n[0]), placeOf(*cloth.m_faces[f].m_n[1]),
                                 placeOf(*cloth.m_faces[f].m_n[2])};
        probe->listMeeting(corners, meeting);
        pairs += meeting.size();
    }
    const SolidLinks links = solidLinksOf(cloth);
    for (std::size_t i = 0; i < links.nodes().size(); i += 2)
    {
        const Vec3 end = placeOf(cloth.m_nodes[links.nodes()[i + 1]]);
        const Vec3 corners[3] = {placeOf(cloth.m_nodes[links.nodes()[i]]), end, end};
        probe->listMeeting(corners, meeting);
        pairs += meeting.size();
    }
    const bool closed = probe->isClosed();
    for (int i = 0; closed && i < cloth.m_nodes.size(); ++i)
        inside += probe->isInside(placeOf(cloth.m_nodes[i]));
    if (pairs > 0)
        addAbout(cloth, object,
                 std::to_string(pairs) + " pairs of the cloth's faces or links and the mesh's triangles intersect, " +
                     std::to_string(inside) + " of " + std::to_string(cloth.m_nodes.size()) + " nodes are inside; " +
                     (closed ? "the mesh is closed, so that nodes that are not pinned are pushed out"
                             : "the mesh is open, so that the right side is unknown"));
    else if (inside == std::size_t(cloth.m_nodes.size()) && inside > 0)
        addAbout(cloth, object,
                 "the cloth is wholly inside the closed mesh, and stays there unless the mesh is declared one-sided");
}
}  // namespace

std::string diagnosisOf(const Plugin& plugin, const btCollisionWorld& world)
{
    return Diagnosis(plugin, world).text();
}
}  // namespace drape
