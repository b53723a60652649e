#include "packed_rigid.h"

#include <algorithm>

#include "bullet_plugin/core/solver/rigid_rows.h"

namespace drape
{
// Lists the rows of the cloth whose packed indices are in m_packedIndex: those beside resting bodies by node, then the
// others. Anchors go first, and rows of a kind stay in order.
PackedRigid::Rows PackedRigid::sortedRows(const RigidRows& rigid) const
{
    std::vector<bool> isInTurn(m_packedIndex.size(), false);
    for (const RigidAnchor& anchor : rigid.anchors())
        if (m_bodies[anchor.m_body].m_moves) isInTurn[anchor.m_node] = true;
    for (const RigidContact& contact : rigid.contacts())
        if (m_bodies[contact.m_body].m_moves) isInTurn[contact.m_node] = true;
    Rows rows;
    const auto add = [&](const auto& list, bool areContacts)
    {
        for (std::size_t i = 0; i < list.size(); ++i)
        {
            const std::uint32_t node = list[i].m_node;
            rows.push_back({isInTurn[node] ? kInTurn : m_packedIndex[node], areContacts, std::uint32_t(i)});
        }
    };
    add(rigid.anchors(), false);
    add(rigid.contacts(), true);
    std::stable_sort(rows.begin(), rows.end(),
                     [](const Row& a, const Row& b) { return a.m_packedNode < b.m_packedNode; });
    return rows;
}

// Packs rows of the cloth whose packed indices are in m_packedIndex as one run.
void PackedRigid::packRun(std::size_t turn, const RigidRows& rigid, const Row* first, const Row* last)
{
    const auto add = [this](auto& list, auto row)
    {
        row.m_node = m_packedIndex[row.m_node];
        list.push_back(row);
    };
    RigidRun run = {};
    run.m_cloth = m_turns[turn];
    run.m_given = std::uint32_t(turn);
    run.m_firstAnchor = std::uint32_t(m_anchors.size());
    run.m_firstContact = std::uint32_t(m_contacts.size());
    for (const Row* row = first; row != last; ++row)
    {
        if (row->m_isContact)
            add(m_contacts, rigid.contacts()[row->m_index]);
        else
            add(m_anchors, rigid.anchors()[row->m_index]);
    }
    run.m_lastAnchor = std::uint32_t(m_anchors.size());
    run.m_lastContact = std::uint32_t(m_contacts.size());
    m_runs.push_back(run);
}

// Packs a cloth's rows in turn, or else those of each other node as a run.
void PackedRigid::packRuns(std::size_t turn, const RigidRows& rigid, bool inTurn)
{
    const Rows rows = sortedRows(rigid);
    const Row* const end = rows.data() + rows.size();
    for (const Row* row = rows.data(); row != end;)
    {
        const Row* const last =
            std::find_if(row, end, [row](const Row& other) { return other.m_packedNode != row->m_packedNode; });
        if ((row->m_packedNode == kInTurn) == inTurn) packRun(turn, rigid, row, last);
        row = last;
    }
}

void PackedRigid::pack(const std::vector<SolverCloth>& cloths, const std::vector<SolveCloth>& records,
                       const std::vector<std::uint32_t>& nodeOrder)
{
    m_chains.clear();
    m_runs.clear();
    m_anchors.clear();
    m_contacts.clear();
    m_bodies.clear();
    m_given.clear();
    m_turns.clear();
    m_layout = {};
    for (std::size_t i = 0; i < cloths.size(); ++i)
        if (cloths[i].m_rigid) m_turns.push_back(std::uint32_t(i));
    if (m_turns.empty()) return;
    std::sort(m_turns.begin(), m_turns.end(),
              [&](std::uint32_t a, std::uint32_t b) { return cloths[a].m_rigid->turn() < cloths[b].m_rigid->turn(); });
    m_bodies = cloths[m_turns[0]].m_rigid->bodies();
    for (const bool inTurn : {false, true})
    {
        const std::uint32_t first = std::uint32_t(m_runs.size());
        for (std::size_t turn = 0; turn < m_turns.size(); ++turn)
        {
            const RigidRows& rigid = *cloths[m_turns[turn]].m_rigid;
            const SolveRange nodes = records[m_turns[turn]].m_nodes;
            m_packedIndex.resize(nodes.m_count);
            for (std::uint32_t i = 0; i < nodes.m_count; ++i)
                m_packedIndex[nodeOrder[nodes.m_first + i] - nodes.m_first] = i;
            packRuns(turn, rigid, inTurn);
            if (inTurn) m_given.push_back(rigid.given());
        }
        const std::uint32_t last = std::uint32_t(m_runs.size());
        for (std::uint32_t run = first; !inTurn && run < last; ++run)
            m_chains.push_back({run, run + 1});
        if (inTurn && first < last) m_chains.push_back({first, last});
    }
    m_layout.m_chainCount = std::uint32_t(m_chains.size());
    m_layout.m_bodyCount = std::uint32_t(m_bodies.size());
    m_layout.m_givenCount = std::uint32_t(m_given.size());
    m_layout.m_anchorCount = std::uint32_t(m_anchors.size());
}

void PackedRigid::layOutInput(WordOffsets& offsets)
{
    m_layout.m_chains = offsets.add<RigidChain>(m_chains.size());
    m_layout.m_runs = offsets.add<RigidRun>(m_runs.size());
    m_layout.m_anchors = offsets.add<RigidAnchor>(m_anchors.size());
    m_layout.m_contacts = offsets.add<RigidContact>(m_contacts.size());
    m_layout.m_bodiesBefore = offsets.add<RigidBody>(m_bodies.size());
    m_layout.m_givenBefore = offsets.add<RigidGiven>(m_given.size());
}

void PackedRigid::layOutStates(WordOffsets& offsets)
{
    m_layout.m_states = offsets.add<RigidRowState>(m_anchors.size() + m_contacts.size());
}

void PackedRigid::layOutResults(WordOffsets& offsets)
{
    m_layout.m_bodies = offsets.add<RigidBody>(m_bodies.size());
    m_layout.m_given = offsets.add<RigidGiven>(m_given.size());
}

void PackedRigid::copyTo(SolveInputWord* words) const
{
    const auto copy = [words](std::uint32_t offset, const auto& list)
    { copyToWords(words, offset, list.data(), list.size()); };
    copy(m_layout.m_chains, m_chains);
    copy(m_layout.m_runs, m_runs);
    copy(m_layout.m_anchors, m_anchors);
    copy(m_layout.m_contacts, m_contacts);
    copy(m_layout.m_bodiesBefore, m_bodies);
    copy(m_layout.m_givenBefore, m_given);
}

void PackedRigid::unpack(std::size_t cloth, RigidRows& rows, const SolveWorkWord* words) const
{
    const auto turn = std::find(m_turns.begin(), m_turns.end(), std::uint32_t(cloth)) - m_turns.begin();
    rows.takeOver(reinterpret_cast<const RigidGiven*>(words + m_layout.m_given)[turn],
                  reinterpret_cast<const RigidBody*>(words + m_layout.m_bodies));
}
}  // namespace drape
