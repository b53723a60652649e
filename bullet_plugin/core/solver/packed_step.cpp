#include "packed_step.h"

#include <algorithm>
#include <cstring>

#include "step_solver.h"

namespace drape
{
namespace
{
constexpr std::size_t kAlignment = 4;  // words

// Returns the number of words of an array, up to where the next one begins.
template <class T>
std::size_t wordsOf(std::size_t count)
{
    const std::size_t words = count * sizeof(T) / sizeof(std::uint32_t);
    return (words + kAlignment - 1) / kAlignment * kAlignment;
}

// Places arrays one behind the other.
class Places
{
public:
    template <class T>
    std::uint32_t add(std::size_t count)
    {
        const std::size_t first = m_words;
        m_words += wordsOf<T>(count);
        return std::uint32_t(first);
    }
    std::size_t words() const { return m_words; }

private:
    std::size_t m_words = 0;
};

template <class Word, class T>
void copyTo(Word* words, std::uint32_t place, const T* source, std::size_t count)
{
    if (count > 0) std::memcpy(words + place, source, count * sizeof(T));
}

std::uint32_t levelOf(std::size_t group)
{
    return std::uint32_t(63 - __builtin_clzll(group));
}

// Keys of features in the order of sweeps: edges after all others; then by level, kind and colour.
constexpr std::uint32_t kKinds = 2;
std::uint32_t keyOf(std::uint32_t levels, std::uint32_t level, std::uint32_t kind, std::uint32_t colour)
{
    const std::uint32_t pass = kind == 2 ? 1 : 0;
    return ((pass * levels + (levels - 1 - level)) * kKinds + (kind == 1 ? 1 : 0)) * kColours + colour;
}
}  // namespace

bool PackedStep::fits(const SolverCloth& cloth, const ContactSource& source)
{
    const ClothContacts& contacts = *cloth.m_contacts;
    if (!cloth.m_substeps || cloth.m_rigid || !contacts.m_limit.faces()) return false;
    if (contacts.m_nodes.count() > SolveStage::kMostNodes) return false;
    for (const MotionLimit::Region& region : contacts.m_limit.regions())
        if (region.m_carry.m_starts) return false;
    if (contacts.m_features.empty()) return true;
    // Contacts of the caller's own come first.
    const Contact* const first = contacts.m_features.front().m_contacts;
    return first >= source.list().begin() && first < source.list().end();
}

void PackedStep::packLinks(const LinkSweep& links, std::uint32_t leafCount, Cloth& cloth)
{
    const std::uint32_t levels = levelOf(leafCount) + 1;
    const auto keyOf = [&](std::uint32_t group, std::uint32_t colour)
    { return (levels - 1 - levelOf(group)) * kColours + colour; };
    std::vector<std::uint32_t> firsts(levels * kColours + 1, 0);
    links.forLinks([&](std::uint32_t group, std::uint32_t colour, const std::uint32_t*, float, float)
                   { ++firsts[keyOf(group, colour) + 1]; });
    firsts[0] = std::uint32_t(m_links.size());
    cloth.m_links = {firsts[0], std::uint32_t(links.linkCount())};
    for (std::size_t key = 1; key < firsts.size(); ++key)
        firsts[key] += firsts[key - 1];
    cloth.m_linkBatches.m_first = std::uint32_t(m_linkBatches.size());
    for (std::uint32_t key = 0; key + 1 < firsts.size(); ++key)
        if (firsts[key] < firsts[key + 1])
            m_linkBatches.push_back({firsts[key], firsts[key + 1], key % kColours == kLastColour, key / kColours});
    cloth.m_linkBatches.m_count = std::uint32_t(m_linkBatches.size()) - cloth.m_linkBatches.m_first;
    m_links.resize(firsts.back());
    links.forLinks(
        [&](std::uint32_t group, std::uint32_t colour, const std::uint32_t* nodes, float restSquared, float strength) {
            m_links[firsts[keyOf(group, colour)]++] = {{nodes[0], nodes[1]}, restSquared, strength};
        });
}

void PackedStep::packFaces(const ClothFaces& faces, Cloth& cloth)
{
    const std::uint32_t firstFace = std::uint32_t(m_faces.size() / 3);
    const std::uint32_t firstOfNode = std::uint32_t(m_facesOfNode.size());
    cloth.m_faceLists = std::uint32_t(m_faceLists.size());
    for (std::size_t node = 0; node <= faces.nodeCount(); ++node)
        m_faceLists.push_back(firstOfNode + std::uint32_t(faces.firsts()[node]));
    for (const std::uint32_t face : faces.facesOfNodes())
        m_facesOfNode.push_back(firstFace + face);
    for (const std::int32_t node : faces.triangles())
        m_faces.push_back(std::uint32_t(node));
}

// Packs links and faces, unless the same cloths had them in the stage's last step.
void PackedStep::packTopology(std::uint64_t stageRevision)
{
    m_step.m_topology = nullptr;
    std::vector<TopologyKey> keys;
    for (const SolverCloth& cloth : m_cloths)
        keys.emplace_back(cloth.m_substeps->links().revision(), cloth.m_contacts->m_limit.faces()->revision());
    if (keys == m_topologyOf && stageRevision == m_stageRevision) return;
    m_topologyOf.clear();
    m_stageRevision = stageRevision;
    m_packed.assign(m_cloths.size(), Cloth());
    m_links.clear();
    m_linkBatches.clear();
    m_faceLists.clear();
    m_facesOfNode.clear();
    m_faces.clear();
    for (std::size_t i = 0; i < m_cloths.size(); ++i)
    {
        const LinkSweep& links = m_cloths[i].m_substeps->links();
        packLinks(links, std::uint32_t(links.leafCount()), m_packed[i]);
        packFaces(*m_cloths[i].m_contacts->m_limit.faces(), m_packed[i]);
    }
    Places places;
    SolveLayout& layout = m_step.m_layout;
    layout.m_links = places.add<SolveLink>(m_links.size());
    layout.m_faceLists = places.add<std::uint32_t>(m_faceLists.size());
    layout.m_facesOfNode = places.add<std::uint32_t>(m_facesOfNode.size());
    layout.m_faces = places.add<std::uint32_t>(m_faces.size());
    m_topology.assign(places.words(), SolveTopologyWord());
    copyTo(m_topology.data(), layout.m_links, m_links.data(), m_links.size());
    copyTo(m_topology.data(), layout.m_faceLists, m_faceLists.data(), m_faceLists.size());
    copyTo(m_topology.data(), layout.m_facesOfNode, m_facesOfNode.data(), m_facesOfNode.size());
    copyTo(m_topology.data(), layout.m_faces, m_faces.data(), m_faces.size());
    m_step.m_topology = m_topology.data();
    m_step.m_topologyWords = m_topology.size();
    m_topologyOf = std::move(keys);
}

std::uint32_t PackedStep::addSurface(const float* map, float thickness, float friction)
{
    SolveSurface surface = {};
    if (map) std::copy(map, map + 12, surface.m_map);
    surface.m_thickness = thickness;
    surface.m_friction = friction;
    surface.m_moves = map ? 1 : 0;
    m_surfaces.push_back(surface);
    return std::uint32_t(m_surfaces.size() - 1);
}

void PackedStep::packRegions(const MotionLimit& limit, SolveCloth& cloth)
{
    cloth.m_regions = {std::uint32_t(m_regions.size()), std::uint32_t(limit.regions().size())};
    for (const MotionLimit::Region& region : limit.regions())
    {
        const std::uint32_t surface = addSurface(region.m_carry.m_map, 0, 0);
        m_regions.push_back({region.m_box.m_low, region.m_box.m_high, region.m_allowance.m_start,
                             region.m_allowance.m_end, surface, region.m_carry.moves() ? 1u : 0u});
    }
}

// Makes a batch of each key's features. Batches of nodes are listed a second time, by themselves.
void PackedStep::addBatches(SolveCloth& cloth, std::uint32_t levels)
{
    const auto add = [&](std::uint32_t first, std::uint32_t last, bool nodesAlone)
    {
        SolveRange range = {std::uint32_t(m_batches.size()), 0};
        for (std::uint32_t key = first; key < last; ++key)
        {
            const bool isNode = key / kColours % kKinds == 0;
            if (m_firsts[key] == m_firsts[key + 1] || (nodesAlone && !isNode)) continue;
            m_batches.push_back(
                {m_firsts[key], m_firsts[key + 1], key % kColours == kLastColour, key / kColours / kKinds % levels});
            ++range.m_count;
        }
        return range;
    };
    const std::uint32_t edges = levels * kKinds * kColours;
    cloth.m_faceBatches = add(0, edges, false);
    cloth.m_edgeBatches = add(edges, 2 * edges, false);
    cloth.m_nodeBatches = add(0, edges, true);
}

void PackedStep::packFeatures(const ClothContacts& contacts, const ContactSource& source, SolveCloth& cloth)
{
    const ClothParts& parts = *contacts.m_parts;
    const std::uint32_t levels = levelOf(parts.leafCount()) + 1;
    if (m_colourings.size() < levels) m_colourings.resize(levels);
    m_entries.clear();
    m_firsts.assign(2 * levels * kKinds * kColours + 1, 0);
    std::uint32_t kind = ~0u;
    for (const FeatureContacts& feature : contacts.m_features)
    {
        if (feature.kind() != kind)
            for (std::uint32_t level = 0; level < levels; ++level)
                m_colourings[level].resize(parts.nodeCount());
        kind = feature.kind();
        const std::uint32_t level = levelOf(parts.groupOf(feature.m_nodes));
        const std::uint32_t colour = m_colourings[level].take(feature.m_nodes, feature.nodeCount());
        m_entries.push_back({keyOf(levels, level, kind, colour), &feature});
        ++m_firsts[m_entries.back().m_key + 1];
    }
    m_firsts[0] = std::uint32_t(m_features.size());
    for (std::size_t key = 1; key < m_firsts.size(); ++key)
        m_firsts[key] += m_firsts[key - 1];
    addBatches(cloth, levels);
    cloth.m_features = {std::uint32_t(m_features.size()), std::uint32_t(m_entries.size())};
    m_features.resize(m_features.size() + m_entries.size());
    std::size_t blocks = 0, slot = SIZE_MAX;
    std::uint32_t surface = 0;
    std::vector<std::pair<std::size_t, std::uint32_t>> surfaces;  // by the obstacle's slot
    const auto surfaceAt = [&](const Contact& contact)
    {
        const std::size_t obstacle = source.obstacleSlot(contact);
        if (obstacle == slot) return surface;
        slot = obstacle;
        const auto known =
            std::find_if(surfaces.begin(), surfaces.end(), [&](const auto& entry) { return entry.first == obstacle; });
        if (known != surfaces.end()) return surface = known->second;
        const ContactView view = source.view(contact);
        const ObstacleSurface& named = source.surfaceOf(view.m_obstacle);
        surface =
            addSurface(named.m_moves ? named.m_map : nullptr, view.m_thickness, contacts.m_friction * named.m_friction);
        surfaces.emplace_back(obstacle, surface);
        return surface;
    };
    for (const Entry& entry : m_entries)
    {
        const FeatureContacts& feature = *entry.m_feature;
        SolveFeature& packed = m_features[m_firsts[entry.m_key]++];
        for (int k = 0; k < 3; ++k)
            packed.m_nodes[k] = std::uint32_t(feature.m_nodes[k]);
        packed.m_nodeCount = std::uint32_t(feature.nodeCount());
        packed.m_firstContact = std::uint32_t(feature.m_contacts - source.list().begin());
        packed.m_contactCount = feature.m_count;
        for (std::uint32_t i = 0; i < feature.m_count; ++i)
            m_surfaceOf[packed.m_firstContact + i] = surfaceAt(feature.m_contacts[i]);
        blocks += ContactGroup::blocksOf(feature.m_count);
    }
    cloth.m_mostClosing = std::uint32_t(mostClosingSweeps(blocks));
}

void PackedStep::packCloth(std::size_t index, const ContactSource& source)
{
    const ClothContacts& contacts = *m_cloths[index].m_contacts;
    Substeps& substeps = *m_cloths[index].m_substeps;
    const MotionLimit& limit = contacts.m_limit;
    SolveCloth cloth = {};
    cloth.m_nodes = {std::uint32_t(m_step.m_nodeCount), std::uint32_t(contacts.m_nodes.count())};
    m_step.m_nodeCount += contacts.m_nodes.count();
    m_step.m_mostNodes = std::max(m_step.m_mostNodes, contacts.m_nodes.count());
    cloth.m_links = m_packed[index].m_links;
    cloth.m_linkBatches = m_packed[index].m_linkBatches;
    cloth.m_faceLists = m_packed[index].m_faceLists;
    cloth.m_substeps = std::uint32_t(substeps.count());
    cloth.m_linkSweeps = Substeps::kLinkSweeps;
    cloth.m_leastClosing = kClosingSweeps;
    cloth.m_levels = levelOf(contacts.m_parts->leafCount()) + 1;
    cloth.m_actingSweeps = std::uint32_t(actingSweepsOf(substeps.count()));
    cloth.m_rests = limit.obstaclesRest() ? 1 : 0;
    cloth.m_substepTime = substeps.substepTime();
    cloth.m_perStep = substeps.perStep();
    cloth.m_pathShare = substeps.pathTime();
    cloth.m_perCorrection = 1 / substeps.correctionTime();
    cloth.m_kept = substeps.kept();
    cloth.m_perShift = contacts.m_perSecond * contacts.m_kept;
    cloth.m_perSecond = contacts.m_perSecond;
    cloth.m_hardness = contacts.m_hardness;
    cloth.m_mostThickness = contacts.m_mostThickness;
    cloth.m_fineViolation = kClosingTolerance * contacts.m_leastThickness;
    cloth.m_tolerated = toleratedViolation(contacts);
    cloth.m_mostViolation = kMostViolation * contacts.m_leastThickness;
    cloth.m_nearDistance = kNearShare * contacts.m_leastThickness;
    cloth.m_sure = limit.sureDistance();
    cloth.m_leastTolerance = limit.leastTolerance();
    if (!contacts.m_features.empty())
    {
        cloth.m_margin = levelMargin(contacts);
        cloth.m_retreat = limit.mostCarried(contacts.m_nodes);
        packFeatures(contacts, source, cloth);
    }
    packRegions(limit, cloth);
    m_clothRecords.push_back(cloth);
}

// Lays out the arrays and fills the input.
void PackedStep::layOut(const ContactSource& source, SolveStage& stage)
{
    SolveLayout& layout = m_step.m_layout;
    Places input, work;
    layout.m_cloths = input.add<SolveCloth>(m_clothRecords.size());
    layout.m_paths = input.add<NodePath>(m_step.m_nodeCount);
    layout.m_accelerations = input.add<Vec3>(m_step.m_nodeCount);
    layout.m_batches = input.add<SolveBatch>(m_batches.size());
    layout.m_features = input.add<SolveFeature>(m_features.size());
    layout.m_surfaceOf = input.add<std::uint32_t>(m_surfaceOf.size());
    layout.m_surfaces = input.add<SolveSurface>(m_surfaces.size());
    layout.m_regions = input.add<SolveRegion>(m_regions.size());
    layout.m_nodes = work.add<SolverNode>(m_step.m_nodeCount);
    layout.m_states = work.add<NodeState>(m_step.m_nodeCount);
    layout.m_results = work.add<SolveResult>(m_clothRecords.size());
    m_step.m_resultWords = work.words();
    layout.m_allowances = work.add<SolveAllowance>(m_step.m_nodeCount);
    layout.m_planes = work.add<SolvePlane>(source.list().size());
    layout.m_acting = work.add<ActingContact>(source.list().size());
    layout.m_spans = work.add<SolveSpan>(m_links.size());
    layout.m_featureStates = work.add<SolveFeatureState>(m_features.size());
    layout.m_lists = work.add<std::uint32_t>(source.list().size());
    m_step.m_workWords = work.words();
    m_step.m_inputWords = input.words();
    SolveInputWord* const words = stage.input(m_step.m_inputWords);
    m_step.m_input = words;
    copyTo(words, layout.m_cloths, m_clothRecords.data(), m_clothRecords.size());
    copyTo(words, layout.m_batches, m_batches.data(), m_batches.size());
    copyTo(words, layout.m_features, m_features.data(), m_features.size());
    copyTo(words, layout.m_surfaceOf, m_surfaceOf.data(), m_surfaceOf.size());
    copyTo(words, layout.m_surfaces, m_surfaces.data(), m_surfaces.size());
    copyTo(words, layout.m_regions, m_regions.data(), m_regions.size());
    for (std::size_t i = 0; i < m_cloths.size(); ++i)
    {
        const SolverNodes& nodes = m_cloths[i].m_contacts->m_nodes;
        const std::uint32_t first = m_clothRecords[i].m_nodes.m_first;
        copyTo(words, layout.m_paths + std::uint32_t(first * sizeof(NodePath) / sizeof(*words)), nodes.paths(),
               nodes.count());
        copyTo(words, layout.m_accelerations + std::uint32_t(first * sizeof(Vec3) / sizeof(*words)),
               m_cloths[i].m_substeps->accelerations(), nodes.count());
    }
    m_step.m_contacts = source.list().begin();
    m_step.m_contactCount = source.list().size();
}

void PackedStep::pack(const std::vector<SolverCloth>& cloths, const ContactSource& source, SolveStage& stage)
{
    m_cloths = cloths;
    packTopology(stage.revision());
    m_clothRecords.clear();
    m_batches = m_linkBatches;
    m_features.clear();
    m_surfaceOf.assign(source.list().size(), 0);
    m_surfaces.clear();
    m_regions.clear();
    m_step.m_clothCount = cloths.size();
    m_step.m_nodeCount = m_step.m_mostNodes = 0;
    for (std::size_t i = 0; i < m_cloths.size(); ++i)
        packCloth(i, source);
    layOut(source, stage);
}

void PackedStep::unpack(const SolveWorkWord* words) const
{
    for (std::size_t i = 0; i < m_cloths.size(); ++i)
    {
        SolverNodes& nodes = m_cloths[i].m_contacts->m_nodes;
        const std::uint32_t first = m_clothRecords[i].m_nodes.m_first;
        const auto copyFrom = [&](std::uint32_t place, auto* target, std::size_t count)
        { std::memcpy(target, words + place + first * sizeof(*target) / sizeof(*words), count * sizeof(*target)); };
        copyFrom(m_step.m_layout.m_nodes, nodes.nodes(), nodes.count());
        copyFrom(m_step.m_layout.m_states, nodes.states(), nodes.count());
        SolveResult result;
        std::memcpy(&result, words + m_step.m_layout.m_results + i * sizeof(result) / sizeof(*words), sizeof(result));
        m_cloths[i].m_contacts->m_mayHavePassed = result.m_mayHavePassed != 0;
    }
}
}  // namespace drape
