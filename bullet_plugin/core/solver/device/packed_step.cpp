#include "packed_step.h"

#include <algorithm>

#include "bullet_plugin/core/scene/scene.h"
#include "bullet_plugin/core/solver/rigid_rows.h"
#include "bullet_plugin/core/solver/step_solver.h"
#include "word_offsets.h"

namespace drape
{
namespace
{
constexpr int kMostSubsteps = 0xfff0;  // a record of pushes has 16 bits for the stage
}  // namespace

bool PackedStep::fits(const SolverCloth& cloth)
{
    const ClothContacts& contacts = *cloth.m_contacts;
    if (!cloth.m_substeps || !contacts.m_limit.faces() || contacts.m_isFiltered) return false;
    // Links and contacts of a large cloth must have the same groups.
    if (contacts.m_parts->leafCount() > 1 && cloth.m_substeps->links().partsRevision() != contacts.m_parts->revision())
        return false;
    if (contacts.m_order && contacts.m_order->anyUncoloured()) return false;
    if (cloth.m_substeps->count() > kMostSubsteps) return false;
    const std::vector<MotionLimit::Region>& regions = contacts.m_limit.regions();
    return std::none_of(regions.begin(), regions.end(),
                        [](const MotionLimit::Region& region) { return region.m_carry.m_starts != nullptr; });
}

void PackedStep::packRegions(const ClothContacts& contacts, const ContactSource& source, SolveCloth& cloth)
{
    const std::vector<MotionLimit::Region>& regions = contacts.m_limit.regions();
    cloth.m_surfaces = {std::uint32_t(m_surfaces.size()), std::uint32_t(contacts.m_obstacles.size())};
    cloth.m_regions = {std::uint32_t(m_regions.size()), std::uint32_t(regions.size())};
    for (const ClothObstacle& obstacle : contacts.m_obstacles)
    {
        const ObstacleSurface& named = source.surfaceOf(obstacle.m_mesh);
        SolveSurface surface = {};
        if (named.m_moves) std::copy(named.m_map, named.m_map + 12, surface.m_map);
        surface.m_thickness = obstacle.m_thickness;
        surface.m_friction = contacts.m_friction * named.m_friction;
        surface.m_moves = named.m_moves ? 1 : 0;
        surface.m_obstacle = std::uint32_t(source.scene()->m_obstacles.existingSlot(obstacle.m_mesh));
        m_surfaces.push_back(surface);
    }
    const auto first = m_surfaces.begin() + std::ptrdiff_t(cloth.m_surfaces.m_first);
    for (std::size_t i = 0; i < regions.size(); ++i)
    {
        const MotionLimit::Region& region = regions[i];
        m_regions.push_back({region.m_box.m_low, region.m_box.m_high, region.m_allowance.m_start,
                             region.m_allowance.m_end, first[std::ptrdiff_t(i)].m_obstacle,
                             region.m_carry.moves() ? 1u : 0u});
    }
    std::sort(first, m_surfaces.end(),
              [](const SolveSurface& a, const SolveSurface& b) { return a.m_obstacle < b.m_obstacle; });
    for (auto region = m_regions.begin() + std::ptrdiff_t(cloth.m_regions.m_first); region != m_regions.end(); ++region)
    {
        const auto named =
            std::find_if(first, m_surfaces.end(),
                         [&](const SolveSurface& surface) { return surface.m_obstacle == region->m_surface; });
        region->m_surface = std::uint32_t(named - m_surfaces.begin());
    }
}

// Sets how far the nodes are from the origin, and how far moving obstacles carry them.
void PackedStep::packReach(const SolverCloth& cloth, const ContactSource& source, const SolveStage& stage,
                           SolveCloth& packed) const
{
    const ClothContacts& contacts = *cloth.m_contacts;
    if (contacts.m_obstacles.empty()) return;
    if (!cloth.m_kept)
    {
        const auto which =
            source.onDevice().m_list ? MotionLimit::Carried::AllNodes : MotionLimit::Carried::ContactNodes;
        packed.m_margin = levelMargin(contacts);
        packed.m_retreat = contacts.m_limit.mostCarried(contacts.m_nodes, which);
        return;
    }
    const KeptBoxes& boxes = stage.kept().boxes(cloth.m_kept->m_id);
    float farthest = 0;
    for (std::size_t k = 0; k < 3 * DRAPE_KEPT_BOXES; ++k)
        farthest = std::max({farthest, drapeAbs(boxes.m_low[k / 3][k % 3]), drapeAbs(boxes.m_high[k / 3][k % 3])});
    packed.m_margin = levelMargin(farthest, contacts.m_mostThickness);
    packed.m_retreat = contacts.m_limit.mostCarried(vec3Load(boxes.m_low[0], 0), vec3Load(boxes.m_high[0], 0));
}

void PackedStep::packCloth(std::size_t index, const ContactSource& source, const SolveStage& stage)
{
    const ClothContacts& contacts = *m_cloths[index].m_contacts;
    const Substeps& substeps = *m_cloths[index].m_substeps;
    const MotionLimit& limit = contacts.m_limit;
    SolveCloth cloth = {};
    cloth.m_nodes = {m_topology.firstNode(index), std::uint32_t(contacts.m_nodes.count())};
    cloth.m_faceLists = m_topology.faceLists(index);
    cloth.m_substeps = std::uint32_t(substeps.count());
    cloth.m_linkSweeps = Substeps::kLinkSweeps;
    cloth.m_actingSweeps = std::uint32_t(actingSweepsOf(substeps.count()));
    cloth.m_rests = limit.obstaclesRest() ? 1 : 0;
    cloth.m_settles = cloth.m_rests && substeps.settles() && !m_cloths[index].m_rigid ? 1 : 0;
    cloth.m_substepTime = substeps.substepTime();
    cloth.m_perStep = substeps.perStep();
    cloth.m_pathShare = substeps.pathTime();
    cloth.m_spread = substeps.spread();
    cloth.m_perCorrection = 1 / substeps.correctionTime();
    cloth.m_undamped = substeps.undamped();
    cloth.m_perShift = contacts.m_perSecond * contacts.m_undamped;
    cloth.m_perSecond = contacts.m_perSecond;
    cloth.m_hardness = contacts.m_hardness;
    cloth.m_mostThickness = contacts.m_mostThickness;
    cloth.m_fineViolation = kClosingTolerance * contacts.m_leastThickness;
    cloth.m_tolerated = toleratedViolation(contacts);
    cloth.m_mostViolation = kMostViolation * contacts.m_leastThickness;
    cloth.m_nearDistance = kNearShare * contacts.m_leastThickness;
    cloth.m_sure = limit.sureDistance();
    cloth.m_leastTolerance = limit.leastTolerance();
    packReach(m_cloths[index], source, stage, cloth);
    packRegions(contacts, source, cloth);
    m_clothRecords.push_back(cloth);
}

// Copies what the solver needs of nodes that the host has.
void PackedStep::copyNodesTo(SolveInputWord* words) const
{
    const SolveLayout& layout = m_step.m_layout;
    for (std::size_t i = 0; i < m_cloths.size(); ++i)
    {
        if (m_cloths[i].m_kept) continue;
        const SolverNodes& cloth = m_cloths[i].m_contacts->m_nodes;
        const std::size_t first = m_clothRecords[i].m_nodes.m_first;
        copyToWords(words, layout.m_givenPaths + first * sizeof(NodePath) / sizeof(*words), cloth.paths(),
                    cloth.count());
        const std::size_t firstVector = first * sizeof(Vec3) / sizeof(*words);
        copyToWords(words, layout.m_givenAccelerations + firstVector, m_cloths[i].m_substeps->accelerations(),
                    cloth.count());
        copyToWords(words, layout.m_givenSupports + firstVector, m_cloths[i].m_substeps->supports(), cloth.count());
    }
}

// Lays out the arrays and fills the input.
void PackedStep::layOut(const ContactSource& source, SolveStage& stage)
{
    SolveLayout& layout = m_step.m_layout;
    const std::size_t nodes = m_topology.nodeCount(), cloths = m_clothRecords.size();
    m_step.m_contacts = source.list();
    m_step.m_onDevice = source.onDevice();
    const std::size_t contacts = m_step.m_onDevice.m_list ? m_step.m_onDevice.m_room : m_step.m_contacts.size();
    WordOffsets input, work;
    layout.m_cloths = input.add<SolveCloth>(cloths);
    layout.m_givenPaths = input.add<NodePath>(nodes);
    layout.m_givenAccelerations = input.add<Vec3>(nodes);
    layout.m_givenSupports = input.add<Vec3>(nodes);
    layout.m_surfaces = input.add<SolveSurface>(m_surfaces.size());
    layout.m_regions = input.add<SolveRegion>(m_regions.size());
    layout.m_obstacles = input.add<MeshOffsets>(m_obstacles.size());
    layout.m_obstacleCount = std::uint32_t(m_obstacles.size());
    m_rigid.layOutInput(input);
    layout.m_total = work.add<std::uint32_t>(1);
    layout.m_buckets = work.add<SolveBucket>(m_topology.bucketCount());
    layout.m_progress = work.add<SolveProgress>(cloths);
    layout.m_allowances = work.add<SolveAllowance>(nodes);
    m_rigid.layOutStates(work);
    m_step.m_clearedWords = work.words();
    layout.m_results = work.add<SolveResult>(cloths);
    m_rigid.layOutResults(work);
    m_step.m_rigid = m_rigid.layout();
    m_step.m_resultWords = work.words() - m_step.m_clearedWords;
    layout.m_nodes = work.add<SolverNode>(nodes);
    layout.m_states = work.add<NodeState>(nodes);
    const bool allKept = m_step.m_kept.size() == m_cloths.size();
    if (!allKept) m_step.m_resultWords = work.words() - m_step.m_clearedWords;
    layout.m_paths = work.add<NodePath>(nodes);
    layout.m_accelerations = work.add<Vec3>(nodes);
    layout.m_supports = work.add<Vec3>(nodes);
    layout.m_sorted = work.add<SolveContact>(contacts);
    layout.m_order = work.add<std::uint32_t>(contacts);
    layout.m_acting = work.add<ActingContact>(contacts);
    layout.m_spans = work.add<SolveSpan>(m_topology.linkCount());
    layout.m_marks = work.add<std::uint32_t>(nodes);
    m_step.m_workWords = work.words();
    m_step.m_inputWords = input.words();
    SolveInputWord* const words = stage.input(m_step.m_inputWords);
    m_step.m_input = words;
    copyToWords(words, layout.m_cloths, m_clothRecords.data(), cloths);
    copyToWords(words, layout.m_surfaces, m_surfaces.data(), m_surfaces.size());
    copyToWords(words, layout.m_regions, m_regions.data(), m_regions.size());
    copyToWords(words, layout.m_obstacles, m_obstacles.data(), m_obstacles.size());
    m_rigid.copyTo(words);
    copyNodesTo(words);
}

// Lists the cloths whose nodes stay on the device.
void PackedStep::packKept(const SolveStage& stage)
{
    m_step.m_kept.clear();
    for (std::size_t i = 0; i < m_cloths.size(); ++i)
    {
        if (!m_cloths[i].m_kept) continue;
        KeptCloth kept = stage.kept().clothOf(*m_cloths[i].m_kept);
        kept.m_solved = m_clothRecords[i].m_nodes.m_first;
        kept.m_mostOffPath = m_cloths[i].m_contacts->m_limit.freeDistance();
        kept.m_leastThickness = m_cloths[i].m_contacts->m_leastThickness;
        m_step.m_kept.push_back(kept);
    }
}

// Counts what the passes over large cloths need.
void PackedStep::describeLaunches()
{
    m_step.m_small = m_topology.small();
    m_step.m_whole = m_topology.whole();
    m_step.m_levels = m_topology.levels();
    m_step.m_clothCount = m_cloths.size();
    m_step.m_substeps = m_step.m_regions = 0;
    m_step.m_mostNodes = 0;
    m_step.m_rests = true;
    for (std::size_t i = 0; i < m_cloths.size(); ++i)
    {
        const ClothParts& parts = *m_cloths[i].m_contacts->m_parts;
        for (std::size_t leaf = 0; leaf < parts.leafCount(); ++leaf)
            m_step.m_mostNodes = std::max(m_step.m_mostNodes, parts.firstNode(leaf + 1) - parts.firstNode(leaf));
        if (!PackedTopology::isByPasses(m_cloths[i])) continue;
        const SolveCloth& cloth = m_clothRecords[i];
        m_step.m_substeps = std::max(m_step.m_substeps, cloth.m_substeps);
        m_step.m_regions = std::max(m_step.m_regions, cloth.m_regions.m_count);
        m_step.m_rests = m_step.m_rests && cloth.m_rests;
    }
}

void PackedStep::pack(const std::vector<SolverCloth>& cloths, const ContactSource& source, SolveStage& stage)
{
    m_cloths = cloths;
    const MeshPool* const meshes = source.scene() ? &source.scene()->m_cloths : nullptr;
    m_topology.pack(cloths, meshes);
    m_step.m_topology = m_topology.words().data();
    m_step.m_topologyWords = m_topology.words().size();
    m_step.m_topologyRevision = m_topology.revision();
    m_topology.describe(m_step.m_layout);
    m_clothRecords.clear();
    m_surfaces.clear();
    m_regions.clear();
    m_obstacles.clear();
    for (std::size_t slot = 0; source.scene() && slot < source.scene()->m_obstacles.meshCount(); ++slot)
        m_obstacles.push_back(source.scene()->m_obstacles.begin(slot));
    for (std::size_t i = 0; i < m_cloths.size(); ++i)
        packCloth(i, source, stage);
    m_rigid.pack(m_cloths, m_clothRecords, m_topology.nodeOrder());
    packKept(stage);
    layOut(source, stage);
    describeLaunches();
}

void PackedStep::unpackNodes(std::size_t cloth, const SolveWorkWord* words) const
{
    const SolveLayout& layout = m_step.m_layout;
    const auto* const ends = reinterpret_cast<const SolverNode*>(words + (layout.m_nodes - m_step.m_clearedWords));
    const auto* const states = reinterpret_cast<const NodeState*>(words + (layout.m_states - m_step.m_clearedWords));
    const std::vector<std::uint32_t>& nodeOrder = m_topology.nodeOrder();
    SolverNodes& nodes = m_cloths[cloth].m_contacts->m_nodes;
    const std::size_t first = m_clothRecords[cloth].m_nodes.m_first;
    for (std::size_t i = first; i < first + nodes.count(); ++i)
    {
        nodes.nodes()[nodeOrder[i] - first] = ends[i];
        nodes.states()[nodeOrder[i] - first] = states[i];
    }
}

// Returns whether the device has solved the cloth.
bool PackedStep::isSolved(std::size_t cloth, const SolveResult& result, bool behind) const
{
    if (result.m_refused || (behind && result.m_meets)) return false;
    return !(m_cloths[cloth].m_kept && result.m_mayHavePassed);
}

void PackedStep::unpack(const SolveWorkWord* words, SolveStage& stage, bool behind) const
{
    const SolveLayout& layout = m_step.m_layout;
    const SolveWorkWord* const work = words - m_step.m_clearedWords;
    const auto* const results = reinterpret_cast<const SolveResult*>(work + layout.m_results);
    const auto moves = [this](std::size_t i) { return m_cloths[i].m_rigid && m_cloths[i].m_rigid->movingRows() > 0; };
    bool areMovedSolved = true;
    for (std::size_t i = 0; i < m_cloths.size(); ++i)
        areMovedSolved = areMovedSolved && (isSolved(i, results[i], behind) || !moves(i));
    std::size_t kept = 0;  // index among kept cloths
    for (std::size_t i = 0; i < m_cloths.size(); ++i)
    {
        const KeptStep* const step = m_cloths[i].m_kept;
        const std::size_t keptIndex = step ? kept++ : 0;
        if (!isSolved(i, results[i], behind) || (!areMovedSolved && moves(i))) continue;
        if (step && !stage.kept().isGood(keptIndex)) continue;
        if (step)
            stage.kept().accept(step->m_id, keptIndex);
        else
            unpackNodes(i, words);
        if (m_cloths[i].m_rigid) m_rigid.unpack(i, *m_cloths[i].m_rigid, work);
        m_cloths[i].m_contacts->m_mayHavePassed = results[i].m_mayHavePassed != 0;
        m_cloths[i].m_contacts->m_isSolved = true;
    }
}
}  // namespace drape
