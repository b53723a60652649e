#include "scenes/mesh_builder.h"
#include "scenes/shapes.h"

namespace drape
{
namespace
{
// Numbers the vertices of the stairs' profile on both sides (0 at −z, 1 at +z): base(i) on the floor under riser i,
// low(i) at the foot of riser i, high(i) at its head. The foot of the first riser is on the floor; that of the one
// after the last step is the top tread's end.
struct StairVertices
{
    int m_steps;

    int sideCount() const { return 3 * m_steps + 1; }
    int base(int side, int i) const { return side * sideCount() + i; }
    int low(int side, int i) const { return i == 0 ? base(side, 0) : side * sideCount() + m_steps + i; }
    int high(int side, int i) const { return side * sideCount() + 2 * m_steps + 1 + i; }
};

void addSideVertices(TriangleMesh& mesh, float width, float height, double z, int steps)
{
    const auto x = [=](int i) { return width * (static_cast<double>(i) / steps - 0.5); };
    const auto y = [=](int i) { return height * static_cast<double>(i) / steps; };
    for (int i = 0; i <= steps; ++i)
        addVertex(mesh, x(i), 0, z);
    for (int i = 1; i <= steps; ++i)
        addVertex(mesh, x(i), y(i), z);
    for (int i = 0; i < steps; ++i)
        addVertex(mesh, x(i), y(i + 1), z);
}

// Adds the wall below tread i: a fan from its lower right corner.
void addWall(TriangleMesh& mesh, const StairVertices& at, int side, int i)
{
    const int rim[4] = {at.base(side, i), at.low(side, i), at.high(side, i), at.low(side, i + 1)};
    const int corner = at.base(side, i + 1);
    for (int k = 0; k < 3; ++k)
        if (rim[k] != rim[k + 1])
            addTriangle(mesh, corner, side == 0 ? rim[k] : rim[k + 1], side == 0 ? rim[k + 1] : rim[k]);
}
}  // namespace

TriangleMesh makeStairs(float width, float height, float depth, int steps)
{
    TriangleMesh mesh;
    const StairVertices at{steps};
    addSideVertices(mesh, width, height, -0.5 * depth, steps);
    addSideVertices(mesh, width, height, 0.5 * depth, steps);
    for (int i = 0; i < steps; ++i)
    {
        addQuad(mesh, at.low(0, i), at.low(1, i), at.high(1, i), at.high(0, i));            // riser
        addQuad(mesh, at.high(0, i), at.high(1, i), at.low(1, i + 1), at.low(0, i + 1));    // tread
        addQuad(mesh, at.base(0, i), at.base(0, i + 1), at.base(1, i + 1), at.base(1, i));  // floor
        for (int side = 0; side < 2; ++side)
            addWall(mesh, at, side, i);
    }
    addQuad(mesh, at.base(0, steps), at.low(0, steps), at.low(1, steps), at.base(1, steps));  // back
    return mesh;
}
}  // namespace drape
