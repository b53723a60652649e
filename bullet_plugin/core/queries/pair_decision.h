// Decides the pairs of triangles that the certified tests could not reject; counts them and lists them up to a limit.
#pragma once

#include "drape/queries.h"
#include "query_mesh.h"

namespace drape
{
class PairDecision
{
public:
    // a and b: the same mesh for a mesh with itself. radius: m. limit: maximum length of a list. Writes to `found`,
    // whose lists and counts are empty.
    PairDecision(const QueryMesh& a, const QueryMesh& b, double radius, std::size_t limit, MeshPairs& found)
        : m_a(a), m_b(b), m_radius(radius), m_limit(limit), m_found(found)
    {
    }

    void take(const PairAnswer& answer);
    // When all are taken: sorts.
    void finish();

private:
    void list(const NearTriangles& pair, bool meet);

    const QueryMesh &m_a, &m_b;
    double m_radius;
    std::size_t m_limit;
    MeshPairs& m_found;
};
}  // namespace drape
