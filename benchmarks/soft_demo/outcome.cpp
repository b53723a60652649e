#include "benchmarks/soft_demo/outcome.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "benchmarks/soft_demo/rigid_depth.h"

namespace drape::bench
{
namespace
{
constexpr double kBelow = 0.1;  // m

constexpr double kAny = 1e300;
constexpr double kResting = 100;  // mm/s

const MeasureRule kRules[] = {{"invalid", "not finite", -1, 0, 0, kAny},
                              {"nodes_below", "nodes under the ground", -1, 0, 0, kAny},
                              {"depth_mm", "depth, mm", -1, 30, 0.25, kAny},
                              {"stretch", "stretch", -1, 0.1, 0.1, kAny},
                              {"carried", "bodies carried", 1, 0, 0, kAny},
                              {"volume_lost", "volume lost", -1, 0.05, 0.1, kAny},
                              {"pairs", "intersecting pairs", -1, 5, 0.1, kAny},
                              {"rest_mm_s", "speed at the end, mm/s", -1, kResting, 0.5, kResting},
                              {"energy", "energy gained", -1, 0.1, 0.25, kAny},
                              {"travel_m", "travel, m", 0, 1, 0.25, kAny},
                              {"disorder", "out of order", -1, 0, 0, kAny}};

// Height of the wavy ground's triangles above a point of the plane; nothing beside the mesh.
std::optional<double> groundHeight(const TriangleMesh& mesh, double x, double z)
{
    const int points = int(std::lround(std::sqrt(double(mesh.vertexCount()))));
    const double low = mesh.m_positions[0];
    const double column = (x - low) / kGroundCell, row = (z - low) / kGroundCell;
    const int i = int(std::floor(column)), j = int(std::floor(row));
    if (i < 0 || j < 0 || i + 1 >= points || j + 1 >= points) return std::nullopt;
    const auto height = [&](int di, int dj)
    { return double(mesh.m_positions[3 * std::size_t((j + dj) * points + i + di) + 1]); };
    const double u = column - i, v = row - j;
    // The diagonal of a cell runs from its first corner to the opposite one.
    const double corner = u > v ? height(1, 0) : height(0, 1);
    const double towards = u > v ? (1 - u) * height(0, 0) + (u - v) * corner + v * height(1, 1)
                                 : (1 - v) * height(0, 0) + (v - u) * corner + u * height(1, 1);
    return towards;
}

double depthUnderGround(const DemoWorld& world, const btVector3& point)
{
    double top = kGroundTop;
    if (!world.groundMesh().m_positions.empty())
    {
        const std::optional<double> height = groundHeight(world.groundMesh(), double(point.x()), double(point.z()));
        if (!height) return 0;
        top = *height;
    }
    else if (std::max(std::abs(point.x()), std::abs(point.z())) > 100)
        return 0;
    return std::max(0.0, top - double(point.y()));
}

bool isFinite(const btVector3& v)
{
    return std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z());
}

// Nodes, middles of links and middles of faces.
void visitSamples(const btSoftBody& body, const std::function<void(const btVector3&)>& visit)
{
    for (int i = 0; i < body.m_nodes.size(); ++i)
        visit(body.m_nodes[i].m_x);
    for (int i = 0; i < body.m_links.size(); ++i)
        if (body.m_faces.size() == 0) visit((body.m_links[i].m_n[0]->m_x + body.m_links[i].m_n[1]->m_x) / 2);
    for (int i = 0; i < body.m_faces.size(); ++i)
    {
        const btSoftBody::Face& face = body.m_faces[i];
        visit((face.m_n[0]->m_x + face.m_n[1]->m_x + face.m_n[2]->m_x) / 3);
        for (int corner = 0; corner < 3; ++corner)
            visit((face.m_n[corner]->m_x + face.m_n[(corner + 1) % 3]->m_x) / 2);
    }
}

btVector3 centreOf(const btSoftBody& body)
{
    btVector3 sum(0, 0, 0);
    for (int i = 0; i < body.m_nodes.size(); ++i)
        sum += body.m_nodes[i].m_x;
    return sum / btScalar(body.m_nodes.size());
}

// Energy of a mass at a point, above the ground, J.
double energyOf(double mass, const btVector3& point, const btVector3& velocity)
{
    return mass * (kDemoGravity * double(point.y() - kGroundTop) + double(velocity.length2()) / 2);
}

double turnEnergyOf(const btRigidBody& body)
{
    const btVector3 turn = body.getWorldTransform().getBasis().transpose() * body.getAngularVelocity();
    double energy = 0;
    for (int axis = 0; axis < 3; ++axis)
        if (body.getInvInertiaDiagLocal()[axis] > 0)
            energy += double(turn[axis] * turn[axis] / body.getInvInertiaDiagLocal()[axis]) / 2;
    return energy;
}

TriangleMesh facesOf(const DemoWorld& world, std::vector<float> positions)
{
    TriangleMesh mesh;
    mesh.m_positions = std::move(positions);
    std::int32_t first = 0;
    for (const auto& body : world.softBodies())
    {
        for (int i = 0; i < body->m_faces.size(); ++i)
            for (const btSoftBody::Node* node : body->m_faces[i].m_n)
                mesh.m_triangles.push_back(first + std::int32_t(node - &body->m_nodes[0]));
        first += body->m_nodes.size();
    }
    return mesh;
}
}  // namespace

const MeasureRule& ruleOf(Measure measure)
{
    return kRules[std::size_t(measure)];
}

Verdict judge(const Outcome& drape, const Outcome& stock)
{
    std::string better, worse;
    for (std::size_t i = 0; i < drape.size(); ++i)
    {
        if (!drape[i] || !stock[i]) continue;
        const MeasureRule& rule = kRules[i];
        const double own = *drape[i], theirs = *stock[i];
        const double equal = std::max(rule.m_least, rule.m_share * std::min(std::abs(own), std::abs(theirs)));
        if (std::abs(own - theirs) <= equal || std::min(own, theirs) > rule.m_most) continue;
        std::string& list = rule.m_better * (own - theirs) > 0 ? better : worse;
        list += (list.empty() ? "" : ", ") + std::string(rule.m_name);
    }
    if (!worse.empty()) return {"worse", worse};
    if (!better.empty()) return {"better", better};
    return {"same", ""};
}

OutcomeMeter::OutcomeMeter(DemoWorld& world, const DemoScene& scene, int steps)
    : m_world(world), m_scene(scene), m_steps(steps)
{
    for (const auto& body : world.softBodies())
    {
        m_volumes.push_back(double(body->getVolume()));
        m_centres.push_back(centreOf(*body));
    }
    m_energy = m_mostEnergy = energyNow();
    m_before = positions();
}

std::vector<float> OutcomeMeter::positions() const
{
    std::vector<float> all;
    for (const auto& body : m_world.softBodies())
        for (int i = 0; i < body->m_nodes.size(); ++i)
            for (int axis = 0; axis < 3; ++axis)
                all.push_back(float(body->m_nodes[i].m_x[axis]));
    return all;
}

void OutcomeMeter::add()
{
    ++m_step;
    const std::vector<float> now = positions();
    // A cut adds nodes.
    if (now.size() == m_before.size())
    {
        double sum2 = 0;
        for (std::size_t i = 0; i < now.size(); i += 3)
        {
            const btVector3 way(now[i] - m_before[i], now[i + 1] - m_before[i + 1], now[i + 2] - m_before[i + 2]);
            sum2 += double(way.length2()) / (kDemoStep * kDemoStep);
        }
        if (10 * m_step > 9 * m_steps)
        {
            m_speed2 += sum2 / double(now.size() / 3);
            ++m_restSteps;
        }
    }
    m_before = now;
    m_mostEnergy = std::max(m_mostEnergy, energyNow());
    if (m_step <= kTravelSteps) m_travel = travelNow();
    if (2 * m_step <= m_steps) return;
    m_depth = std::max(m_depth, depthNow());
    m_stretches.push_back(stretchNow());
}

double OutcomeMeter::depthNow() const
{
    double deepest = 0;
    const auto visit = [&](const btVector3& point)
    {
        deepest = std::max(deepest, depthUnderGround(m_world, point));
        for (const auto& body : m_world.bodies())
            deepest = std::max(deepest, depthIn(*body->getCollisionShape(), body->getWorldTransform(), point));
    };
    for (const auto& body : m_world.softBodies())
        visitSamples(*body, visit);
    return deepest;
}

double OutcomeMeter::stretchNow() const
{
    double longest = 0;
    for (const auto& body : m_world.softBodies())
    {
        for (int i = 0; i < body->m_links.size(); ++i)
        {
            const btSoftBody::Link& link = body->m_links[i];
            if (link.m_bbending || link.m_rl <= 0) continue;
            longest = std::max(longest, double((link.m_n[0]->m_x - link.m_n[1]->m_x).length() / link.m_rl));
        }
    }
    return longest;
}

double OutcomeMeter::carriedNow() const
{
    double carried = 0;
    for (const auto& body : m_world.bodies())
        carried += body->getInvMass() > 0 && double(body->getWorldTransform().getOrigin().y()) > m_scene.m_level;
    return carried;
}

double OutcomeMeter::volumeLost() const
{
    double lost = 0;
    for (std::size_t i = 0; i < m_volumes.size(); ++i)
        lost += std::max(0.0, 1 - double(m_world.softBodies()[i]->getVolume()) / m_volumes[i]);
    return lost / double(m_volumes.size());
}

double OutcomeMeter::pairsNow()
{
    SelfIntersections intersections(facesOf(m_world, positions()));
    return double(intersections.find(positions()).size());
}

double OutcomeMeter::invalidNow() const
{
    double invalid = 0;
    for (const auto& body : m_world.softBodies())
        for (int i = 0; i < body->m_nodes.size(); ++i)
            invalid += !isFinite(body->m_nodes[i].m_x);
    for (const auto& body : m_world.bodies())
        invalid += !isFinite(body->getWorldTransform().getOrigin());
    return invalid;
}

double OutcomeMeter::energyNow() const
{
    double energy = 0;
    for (const auto& body : m_world.softBodies())
        for (int i = 0; i < body->m_nodes.size(); ++i)
            if (body->m_nodes[i].m_im > 0)
                energy += energyOf(1 / double(body->m_nodes[i].m_im), body->m_nodes[i].m_x, body->m_nodes[i].m_v);
    for (const auto& body : m_world.bodies())
        if (body->getInvMass() > 0)
            energy += energyOf(1 / double(body->getInvMass()), body->getWorldTransform().getOrigin(),
                               body->getLinearVelocity()) +
                      turnEnergyOf(*body);
    return energy;
}

double OutcomeMeter::travelNow() const
{
    double travel = 0;
    for (std::size_t i = 0; i < m_centres.size(); ++i)
        travel += double((centreOf(*m_world.softBodies()[i]) - m_centres[i]).length()) / double(m_centres.size());
    return travel;
}

// The bodies stand in the order of their friction.
double OutcomeMeter::disorder() const
{
    constexpr double kEqual = 0.01;  // m
    const auto way = [this](std::size_t i)
    { return double((centreOf(*m_world.softBodies()[i]) - m_centres[i]).length()); };
    double count = 0;
    for (std::size_t i = 0; i + 1 < m_centres.size(); ++i)
        count += way(i + 1) > way(i) + kEqual;
    return count;
}

double OutcomeMeter::belowNow() const
{
    double below = 0;
    for (const auto& body : m_world.softBodies())
        for (int i = 0; i < body->m_nodes.size(); ++i)
            below += depthUnderGround(m_world, body->m_nodes[i].m_x) > kBelow;
    return below;
}

Outcome OutcomeMeter::finish()
{
    Outcome outcome;
    const auto set = [&](Measure measure, double value) { outcome[std::size_t(measure)] = value; };
    const auto has = [&](unsigned flag) { return (m_scene.m_flags & flag) != 0; };
    set(Measure::Invalid, invalidNow());
    set(Measure::Below, belowNow());
    set(Measure::Depth, 1e3 * m_depth);
    std::sort(m_stretches.begin(), m_stretches.end());
    set(Measure::Stretch, m_stretches.empty() ? 1 : m_stretches[m_stretches.size() / 2]);
    if (has(kLoads)) set(Measure::Carried, carriedNow());
    if (has(kClosed)) set(Measure::VolumeLost, volumeLost());
    if (has(kSoftPairs)) set(Measure::Pairs, pairsNow());
    if (!has(kDriven)) set(Measure::Rest, m_restSteps > 0 ? 1e3 * std::sqrt(m_speed2 / m_restSteps) : 0);
    if (!has(kDriven)) set(Measure::Energy, (m_mostEnergy - m_energy) / m_energy);
    if (has(kFlight)) set(Measure::Travel, m_travel);
    if (has(kByFriction)) set(Measure::Disorder, disorder());
    return outcome;
}
}  // namespace drape::bench
