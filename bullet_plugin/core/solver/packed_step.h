// Packs cloths for the device's solver, and unpacks its results.
//
// Input: cloths as StepSolver takes them, and the contacts of the detection. Links and contacts are sorted by levels of
// the cloth's groups, from the leaves to the root, and by colours (cloth_parts.h, colouring.h), which is the order of
// the host's sweeps. Topology is packed again only when it changed. Cost: linear in the nodes and contacts.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "colouring.h"
#include "contact_sweep.h"
#include "link_sweep.h"
#include "solve_stage.h"

namespace drape
{
class PackedStep
{
public:
    // Returns whether a device can solve the cloth: the core has its links, and its contacts are the detection's own
    // with obstacles that rest or move as rigid bodies.
    static bool fits(const SolverCloth& cloth, const ContactSource& source);

    // Packs cloths that fit. They must stay in place until unpack().
    void pack(const std::vector<SolverCloth>& cloths, const ContactSource& source, SolveStage& stage);
    const SolveStep& step() const { return m_step; }
    // Gives the cloths' nodes the device's result.
    void unpack(const SolveWorkWord* words) const;

private:
    // Revisions of a cloth's links and faces when they were packed.
    using TopologyKey = std::pair<std::uint64_t, std::uint64_t>;
    struct Entry
    {
        std::uint32_t m_key;  // place in the order of the sweeps
        const FeatureContacts* m_feature;
    };
    // Results of packing for one cloth.
    struct Cloth
    {
        SolveRange m_links = {}, m_linkBatches = {};
        std::uint32_t m_faceLists = 0;
    };

    void packTopology(std::uint64_t stageRevision);
    void packLinks(const LinkSweep& links, std::uint32_t leafCount, Cloth& cloth);
    void packFaces(const ClothFaces& faces, Cloth& cloth);
    void packCloth(std::size_t index, const ContactSource& source);
    void packFeatures(const ClothContacts& contacts, const ContactSource& source, SolveCloth& cloth);
    void addBatches(SolveCloth& cloth, std::uint32_t levels);
    std::uint32_t addSurface(const float* map, float thickness, float friction);
    void packRegions(const MotionLimit& limit, SolveCloth& cloth);
    void layOut(const ContactSource& source, SolveStage& stage);

    std::vector<SolverCloth> m_cloths;
    std::vector<TopologyKey> m_topologyOf;
    std::uint64_t m_stageRevision = 0;
    std::vector<Cloth> m_packed;
    std::vector<SolveLink> m_links;
    std::vector<SolveBatch> m_linkBatches;
    std::vector<std::uint32_t> m_faceLists, m_facesOfNode, m_faces;
    std::vector<SolveTopologyWord> m_topology;
    SolveStep m_step;

    std::vector<SolveCloth> m_clothRecords;
    std::vector<SolveBatch> m_batches;
    std::vector<SolveFeature> m_features;
    std::vector<std::uint32_t> m_surfaceOf;
    std::vector<SolveSurface> m_surfaces;
    std::vector<SolveRegion> m_regions;
    std::vector<Colouring> m_colourings;  // by level
    std::vector<Entry> m_entries;
    std::vector<std::uint32_t> m_firsts;  // by key, the first place of its features
};
}  // namespace drape
