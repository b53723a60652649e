// A node's contact normals beside creases. At convex creases they turn no faster than the surface permits; at a concave
// crease both faces have theirs.
//
// Nodes slide at a constant offset over edges and vertices, in steps of a fiftieth of the offset. Each is a corner of a
// triangle of its own that stands off the surface. Lengths in metres.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "scenes/shapes.h"
#include "tests/support/backends.h"
#include "tests/support/oracle.h"
#include "tests/support/pipeline_driver.h"

namespace drape::test
{
namespace
{
constexpr double kOffset = 0.02;
constexpr double kStep = kOffset / 50;
constexpr float kThickness = 0.025f;  // a fifth more than the offset: every contact is one to be solved
constexpr double kReach = 1.5 * double(kThickness);
constexpr int kTracks = 6;
constexpr double kFlag = 0.08;  // height of a node's triangle
constexpr double kRunUp = 0.7;  // angle about the crease at which paths begin and end, radians
constexpr double kUnit = 1.0 / 16777216;

// A convex surface and the paths over it: arcs about the origin, over its top.
struct Surface
{
    std::string m_name;
    TriangleMesh m_mesh;
    double m_radius;     // radius of the arcs
    double m_turn;       // they go this far to either side of the top, radians
    double m_leastTurn;  // turn of the normals along the path, radians
    double m_extent;     // largest coordinate of a node's triangle and one of the surface's, relative to the latter
    Vector3 m_along;     // arcs may lie anywhere along this
};

void addVertex(TriangleMesh& mesh, const Vector3& p)
{
    mesh.m_positions.insert(mesh.m_positions.end(), {float(p.x), float(p.y), float(p.z)});
}

// Makes two faces that meet at the z axis, each 0.3 wide, turned down by half the angle (up if it is negative).
TriangleMesh creaseMesh(double angle)
{
    TriangleMesh mesh;
    const double x = 0.3 * std::cos(angle / 2), y = -0.3 * std::sin(angle / 2);
    for (double z : {-0.3, 0.3})
        for (const Vector3& p : {Vector3{-x, y, z}, Vector3{0, 0, z}, Vector3{x, y, z}})
            addVertex(mesh, p);
    mesh.m_triangles = {0, 3, 1, 1, 3, 4, 1, 4, 2, 2, 4, 5};
    return mesh;
}

Surface creaseSurface(double degrees)
{
    const double angle = degrees * M_PI / 180;
    return {"crease of " + std::to_string(int(degrees)) + " degrees",
            creaseMesh(angle),
            0.08,
            angle / 2 + kRunUp,
            0.99 * angle,
            0.4,
            {0, 0, 0.1}};
}

// Makes faces about the top of a cone, at uneven angles.
Surface fanSurface(int faces, double slope)
{
    Surface fan = {"fan of " + std::to_string(faces), {}, 0.08, slope + kRunUp, slope, 0.4, {}};
    addVertex(fan.m_mesh, {});
    for (int i = 0; i < faces; ++i)
    {
        const double turn = 2 * M_PI * (i + 0.3 * (i % 2)) / faces;
        addVertex(fan.m_mesh, {0.3 * std::cos(turn), -0.3 * std::tan(slope), 0.3 * std::sin(turn)});
        const int next = i + 1 == faces ? 1 : i + 2;
        fan.m_mesh.m_triangles.insert(fan.m_mesh.m_triangles.end(), {0, next, i + 1});
    }
    return fan;
}

std::vector<Surface> convexSurfaces()
{
    std::vector<Surface> surfaces;
    for (double degrees : {3.0, 10.0, 30.0, 60.0, 90.0, 120.0, 160.0})
        surfaces.push_back(creaseSurface(degrees));
    surfaces.push_back(fanSurface(5, 0.3));
    surfaces.push_back(fanSurface(8, 0.9));
    // Creases of 2 to 3 degrees, and vertices; a way passes a dozen.
    surfaces.push_back({"sphere", makeSphere(1.0f, 4), 1 + kOffset, 0.3, 0.5, 0.2, {}});
    return surfaces;
}

// A surface near the ways over it, by brute force.
class Nearest
{
public:
    Nearest(const TriangleMesh& mesh, const Vector3& about, double within)
    {
        for (std::size_t t = 0; t < mesh.triangleCount(); ++t)
        {
            Face face;
            for (std::size_t i = 0; i < 3; ++i)
                face.m_corners[i] = position(mesh.m_positions, std::uint32_t(mesh.m_triangles[3 * t + i]));
            if (nearestOnTriangle(about, face.m_corners).m_distance < within) m_faces.push_back(face);
        }
    }

    // Returns the point at the offset above the point nearest to q, rounded to floats.
    Vector3 offsetAbove(const Vector3& q) const
    {
        NearestOnTriangle best = {INFINITY, {}, {}};
        for (const Face& face : m_faces)
        {
            const NearestOnTriangle here = nearestOnTriangle(q, face.m_corners);
            if (here.m_distance < best.m_distance) best = here;
        }
        const Vector3 p = best.m_point + kOffset * normalized(q - best.m_point);
        return {double(float(p.x)), double(float(p.y)), double(float(p.z))};
    }

private:
    struct Face
    {
        Vector3 m_corners[3];
    };
    std::vector<Face> m_faces;
};

// The paths of some nodes, one node of a triangle each, all with equally many steps.
struct Slide
{
    std::vector<std::vector<Vector3>> m_ways;

    std::size_t steps() const { return m_ways[0].size(); }

    // Positions of all triangles: the node, and two corners above it.
    std::vector<float> positions(std::size_t step) const
    {
        TriangleMesh mesh;
        for (const std::vector<Vector3>& way : m_ways)
            for (const Vector3& corner : {Vector3{0, 0, 0}, Vector3{0.01, kFlag, 0.01}, Vector3{-0.01, kFlag, 0.01}})
                addVertex(mesh, way[step] + corner);
        return mesh.m_positions;
    }
};

Slide slideOver(const Surface& surface, Random& random)
{
    Slide slide;
    const auto count = std::size_t(2 * surface.m_turn * surface.m_radius / kStep) + 2;
    for (int track = 0; track < kTracks; ++track)
    {
        const double heading = double(random.uniform(-0.9f, 0.9f));
        const Vector3 right = {std::cos(heading), 0, std::sin(heading)};
        const Vector3 centre = double(random.uniform(-1, 1)) * surface.m_along;
        const Nearest nearest(surface.m_mesh, centre + Vector3{0, surface.m_radius, 0}, 0.6);
        std::vector<Vector3> way;
        for (std::size_t i = 0; i < count; ++i)
        {
            const double turn = surface.m_turn * (2 * double(i) / double(count - 1) - 1);
            way.push_back(nearest.offsetAbove(centre + surface.m_radius * std::sin(turn) * right +
                                              Vector3{0, surface.m_radius * std::cos(turn), 0}));
        }
        slide.m_ways.push_back(way);
    }
    return slide;
}

// One node's contacts in one step, by obstacle triangle.
using NodeContacts = std::map<std::uint32_t, Contact>;

Vector3 normalOf(const Contact& contact)
{
    return {double(contact.m_normal[0]), double(contact.m_normal[1]), double(contact.m_normal[2])};
}

double angleBetween(const Vector3& a, const Vector3& b)
{
    return std::atan2(length(cross(a, b)), dot(a, b));
}

const Contact& deepest(const NodeContacts& contacts)
{
    return std::min_element(contacts.begin(), contacts.end(),
                            [](const auto& a, const auto& b) { return a.second.m_gap1 < b.second.m_gap1; })
        ->second;
}

// Moves the node along the deepest contact's normal by its depth, and expects all other contacts at the thickness, too.
void expectAsTheDeepest(const NodeContacts& contacts, double slack)
{
    const Contact& first = deepest(contacts);
    for (const auto& [face, contact] : contacts)
    {
        const double moved = (double(kThickness) - double(first.m_gap1)) * dot(normalOf(first), normalOf(contact));
        ASSERT_GE(double(contact.m_gap1) + moved, double(kThickness) - slack) << "face " << face;
    }
}

// Compares contacts with the same face in consecutive steps. `error` is that of a gap.
void expectFacesTurnAsSlowly(const NodeContacts& before, const NodeContacts& after, double way, double error)
{
    for (const auto& [face, contact] : after)
    {
        const auto same = before.find(face);
        if (same == before.end()) continue;
        const double gap = double(std::min(contact.m_gap1, same->second.m_gap1));
        ASSERT_LE(angleBetween(normalOf(contact), normalOf(same->second)),
                  std::asin((way + 2 * error) / gap) + 2 * error / gap)
            << "face " << face;
    }
}

// Runs the slide and gives visit(step, track, the node's contacts).
template <typename Visit>
void run(const Settings& settings, const Slide& slide, const TriangleMesh& surface, Visit visit)
{
    const std::unique_ptr<Pipeline> pipeline = makePipeline(settings);
    ASSERT_TRUE(pipeline);
    TriangleMesh cloth;
    cloth.m_positions = slide.positions(0);
    for (int i = 0; i < int(cloth.vertexCount()); ++i)
        cloth.m_triangles.push_back(i);
    const MeshId clothId = addCloth(*pipeline, cloth), obstacle = addObstacle(*pipeline, surface);
    for (std::size_t step = 0; step < slide.steps(); ++step)
    {
        setMotion(*pipeline, clothId, slide.positions(step == 0 ? 0 : step - 1), slide.positions(step));
        pipeline->addPair(clothId, obstacle, kThickness);
        std::vector<NodeContacts> contacts(slide.m_ways.size());
        for (const Contact& contact : runStep(*pipeline))
        {
            if (contact.m_kind == DRAPE_NODE_FACE && contact.m_clothFeature % 3 == 0)
                contacts[contact.m_clothFeature / 3].emplace(contact.m_obstacleFeature, contact);
        }
        for (std::size_t track = 0; track < contacts.size(); ++track)
        {
            visit(step, track, contacts[track]);
            if (testing::Test::HasFatalFailure()) return;
        }
    }
}
}  // namespace

class ContactNormalsTest : public BackendTest
{
};

// The offset from a convex body is a Lipschitz function of the position, with constant 1. Over a step of length s the
// direction at distance g turns by asin(s / g) at most, and so does each face's own.
// Rounding errs by e = 24 u extent in a gap (three weighted corners, a frame's shift and the difference). Any of
// several nearly equal contacts may therefore seem the deepest. Its foot is within 2 sqrt(e g) of the true one, its
// direction off by 2 sqrt(e / g), before and after.
// All contacts together require no more than the deepest does. After a correction by its depth, the other contacts are
// at the thickness, too. A body on one side of its plane lets nothing else be nearer while the correction is less than
// the gap.
TEST_P(ContactNormalsTest, SmoothOverConvexCreases)
{
    Random random(1500);
    for (const Surface& surface : convexSurfaces())
    {
        const Slide slide = slideOver(surface, random);
        const double error = 24 * kUnit * surface.m_extent, either = 2 * std::sqrt(error / kOffset);
        SCOPED_TRACE("seed 1500, " + surface.m_name);
        std::vector<NodeContacts> before(slide.m_ways.size());
        std::vector<double> turned(slide.m_ways.size(), 0);
        const auto visit = [&](std::size_t step, std::size_t track, const NodeContacts& contacts)
        {
            SCOPED_TRACE("step " + std::to_string(step) + ", node " + std::to_string(track));
            ASSERT_FALSE(contacts.empty());
            ASSERT_NEAR(double(deepest(contacts).m_gap1), kOffset, error + 4 * kUnit);
            expectAsTheDeepest(contacts, (double(kThickness) - kOffset) * either + 2 * error);
            if (step > 0)
            {
                const double way = length(slide.m_ways[track][step] - slide.m_ways[track][step - 1]);
                const double turn = angleBetween(normalOf(deepest(contacts)), normalOf(deepest(before[track])));
                ASSERT_LE(way, 1.01 * kStep);
                ASSERT_LE(turn, std::asin(way / kOffset) + 2 * either);
                expectFacesTurnAsSlowly(before[track], contacts, way, error);
                turned[track] += turn;
            }
            before[track] = contacts;
        };
        run(GetParam().m_settings, slide, surface.m_mesh, visit);
        if (HasFatalFailure()) return;
        for (double turn : turned)
            EXPECT_GE(turn, surface.m_leastTurn) << "it did not go over the crease";
    }
}

// A node in a valley goes down one face and up the other, at the offset of each. Wherever it is within reach of both,
// both have a contact, with the face's own normal.
TEST_P(ContactNormalsTest, BothFacesOfAConcaveCrease)
{
    for (double degrees : {10.0, 45.0, 90.0, 130.0})
    {
        SCOPED_TRACE("valley of " + std::to_string(int(degrees)) + " degrees");
        const double half = degrees * M_PI / 360;
        const TriangleMesh valley = creaseMesh(-2 * half);
        const Vector3 normals[2] = {{std::sin(half), std::cos(half), 0}, {-std::sin(half), std::cos(half), 0}};
        const Vector3 ways[2] = {{-std::cos(half), std::sin(half), 0}, {std::cos(half), std::sin(half), 0}};
        Slide slide;
        slide.m_ways.resize(1);
        constexpr int kSide = 120;
        const Vector3 corner = {0, kOffset / std::cos(half), 0.05};
        for (int i = -kSide; i <= kSide; ++i)
            slide.m_ways[0].push_back(corner + std::abs(i) * kStep * ways[i < 0 ? 0 : 1]);
        int both = 0;
        const auto visit = [&](std::size_t step, std::size_t, const NodeContacts& contacts)
        {
            SCOPED_TRACE("step " + std::to_string(step));
            bool found[2] = {false, false}, wanted[2];
            for (const auto& [triangle, contact] : contacts)
                found[triangle / 2] |= dot(normalOf(contact), normals[triangle / 2]) > 1 - 1e-6;
            for (int face = 0; face < 2; ++face)
            {
                const Vector3& p = slide.m_ways[0][step];
                const bool above = dot(p, ways[face]) > 1e-4;
                wanted[face] = above && dot(p, normals[face]) < kReach * (1 - 1e-4);
                EXPECT_TRUE(found[face] || !wanted[face]) << "face " << face;
            }
            both += wanted[0] && wanted[1];
        };
        run(GetParam().m_settings, slide, valley, visit);
        EXPECT_GT(both, 5) << "in the shallowest valley both feet are inside their faces for nine steps";
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, ContactNormalsTest, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
