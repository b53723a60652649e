// Writes what the C++ interface computes, for the tests of the Python module: drape_python_reference FOLDER
//
// Writes the input, too, so that Python computes the same. Files are little-endian numbers without headers.
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "BulletSoftBody/btSoftBody.h"
#include <drape/queries.h>

#include "scenes/cloth_grid.h"
#include "scenes/describe_mesh.h"
#include "scenes/shapes.h"
#include "tests/cloth_world/hand_built_world.h"

namespace
{
constexpr int kSteps = 60, kPin = 5;

std::string folder;

template <class Value>
void write(const std::string& name, const std::vector<Value>& values)
{
    std::ofstream file(folder + "/" + name, std::ios::binary);
    file.write(reinterpret_cast<const char*>(values.data()), std::streamsize(values.size() * sizeof(Value)));
}

void writeMesh(const std::string& name, const drape::TriangleMesh& mesh)
{
    write(name + ".positions", mesh.m_positions);
    write(name + ".triangles", mesh.m_triangles);
}

drape::Settings onHost()
{
    drape::Settings settings;
    settings.m_backend = drape::Backend::Host;
    return settings;
}

void writeWorld()
{
    const drape::TriangleMesh sheet = drape::makeClothGrid(13, 13, 1, 0.45f).m_mesh, ball = drape::makeSphere(0.4f, 3);
    writeMesh("sheet", sheet);
    writeMesh("ball", ball);
    drape::test::HandBuiltWorld world(onHost(), sheet, ball, kPin);
    std::vector<double> rotations;
    for (int step = 1; step <= kSteps; ++step)
    {
        world.step();
        const std::vector<double> rotation = drape::test::HandBuiltWorld::rotationAfter(step);
        rotations.insert(rotations.end(), rotation.begin(), rotation.end());
    }
    std::vector<btScalar> positions, velocities;
    for (int i = 0; i < world.cloth().m_nodes.size(); ++i)
    {
        const btSoftBody::Node& node = world.cloth().m_nodes[i];
        positions.insert(positions.end(), node.m_x.m_floats, node.m_x.m_floats + 3);
        velocities.insert(velocities.end(), node.m_v.m_floats, node.m_v.m_floats + 3);
    }
    write("rotations", rotations);
    write("positions", positions);
    write("velocities", velocities);
}

// Moves a soup of triangles, and asks about pairs of its triangles, too.
bool writeQueries()
{
    drape::Error error;
    const std::unique_ptr<drape::Queries> queries = drape::Queries::create(onHost(), error);
    if (!queries) return false;
    const drape::TriangleMesh soup = drape::makeSoup(1, 0.3f, 200, 5), other = drape::makeSoup(1, 0.3f, 100, 9);
    writeMesh("soup", soup);
    writeMesh("other", other);
    std::vector<float> end = soup.m_positions;
    for (std::size_t i = 0; i < end.size(); ++i)
        end[i] += 0.1f * float(int(i / 9 % 5) - 2);
    write("end", end);
    const drape::MeshDescription a = drape::describeMesh(soup), b = drape::describeMesh(other);
    drape::MeshPairs pairs, own;
    drape::MeshMotion motion;
    const drape::CcdSettings settings = drape::defaultCcdSettings();
    if (!queries->meshPairs(a, &b, 0.02f, pairs) || !queries->meshPairs(a, nullptr, 0.01f, own) ||
        !queries->meshMotion(a, end.data(), settings, motion))
        return false;
    write("within", pairs.m_within);
    write("intersecting", pairs.m_intersecting);
    write("own", own.m_within);
    write("touching", motion.m_touching);
    write("counts", std::vector<std::uint64_t>{pairs.m_candidates, pairs.m_withinCount, pairs.m_intersectingCount,
                                               motion.m_trianglePairs, motion.m_vertexFaceCandidates,
                                               motion.m_edgeCandidates, motion.m_vertexFaceHits, motion.m_edgeHits});

    // Vertices of one soup fly to or past triangles of the other; later triangles are shrunk onto the first ones.
    std::vector<drape::CcdQuery> questions(100);
    std::vector<drape::TriangleQuery> triangles(100);
    for (std::size_t i = 0; i < questions.size(); ++i)
    {
        drape::CcdQuery& question = questions[i];
        question.m_kind = i % 2 ? DRAPE_EDGES : DRAPE_VERTEX_FACE;
        std::memcpy(question.m_start, &soup.m_positions[9 * i], 3 * sizeof(float));
        std::memcpy(question.m_start + 3, &other.m_positions[9 * i], 9 * sizeof(float));
        std::memcpy(question.m_end, question.m_start, sizeof(question.m_end));
        for (int axis = 0; axis < 3; ++axis)
            question.m_end[axis] = 2 * (question.m_start[6 + axis] + 0.1f * float(i % 3)) - question.m_start[axis];
        std::memcpy(triangles[i].m_a, &soup.m_positions[9 * i], sizeof(triangles[i].m_a));
        std::memcpy(triangles[i].m_b, &soup.m_positions[9 * (i + 100)], sizeof(triangles[i].m_b));
        for (int corner = 0; corner < 9; ++corner)
            triangles[i].m_b[corner] = 0.2f * triangles[i].m_b[corner] + 0.8f * triangles[i].m_a[corner];
    }
    std::vector<drape::CcdResult> results(questions.size());
    std::vector<std::uint32_t> meet(triangles.size());
    if (!queries->motions(questions.data(), questions.size(), settings, results.data()) ||
        !queries->triangles(triangles.data(), triangles.size(), drape::TriangleTest::Exact, meet.data()))
        return false;
    write("questions", questions);
    write("results", results);
    write("triangles", triangles);
    write("meet", meet);
    return true;
}
}  // namespace

int main(int argc, char** argv)
{
    if (argc != 2)
    {
        std::fprintf(stderr, "Usage: drape_python_reference FOLDER\n");
        return 2;
    }
    folder = argv[1];
    writeWorld();
    return writeQueries() ? 0 : 1;
}
