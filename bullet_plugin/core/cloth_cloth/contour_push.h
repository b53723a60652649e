// Displacements that bring intersecting triangles of cloth apart, without a record of how they came there.
//
// Method: two cloths cut each other along a curve, which begins and ends where edges pierce triangles. Each such edge
// goes where the curve gets shorter, and the triangle goes the other way (Volino and Magnenat-Thalmann 2006, Resolving
// Surface Collisions through Intersection Contour Minimization). A corner that pokes through withdraws; a sheet across
// another slides off its border. Cloth that closed curves hold, such as a bag through its own side, comes apart slowly
// or not at all.
//
// Double precision, on the host. Cost: linear in the pairs. The same bits everywhere.
#pragma once

#include <cstdint>
#include <vector>

namespace drape
{
class ContourPush
{
public:
    // Computes the displacements for pairs of triangles that intersect: six nodes a pair, as ClothSet::findMeeting()
    // lists them. positions: x y z per node, m. isHeld: by node; held nodes stay. most: by node, m, how far
    // it is moved at most.
    void compute(const std::vector<std::uint32_t>& pairs, const float* positions,
                 const std::vector<unsigned char>& isHeld, const std::vector<double>& most);
    // Returns the displacements, x y z per node, m; empty if there is no pair.
    const std::vector<double>& displacements() const { return m_displacements; }

private:
    std::vector<double> m_displacements;
};
}  // namespace drape
