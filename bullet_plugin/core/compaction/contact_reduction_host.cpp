#include <algorithm>
#include <numeric>

#include "contact_reduction.h"

namespace drape
{
namespace
{
// Contacts of a piece, with the rest of its last slot's; and from how many on threads are worth waking.
constexpr std::uint32_t kPiece = 256;
constexpr std::uint32_t kLeastShared = 1 << 10;

// Contacts of whole slots from m_first up to m_last, of which m_kept stay.
struct Piece
{
    std::uint32_t m_first, m_last, m_kept;
};

std::vector<Piece> piecesOf(const SlotLists& lists)
{
    std::vector<Piece> pieces;
    for (std::uint32_t first = 0; first < lists.m_count;)
    {
        const std::uint32_t reached = std::min(first + kPiece, lists.m_count);
        const std::uint32_t last = slotEnd(&lists, lists.m_hits[reached - 1].m_slot);
        pieces.push_back({first, last, 0});
        first = last;
    }
    return pieces;
}

// Writes what stays of the piece to `kept`.
void reducePiece(Piece& piece, const SlotLists& lists, const ReductionView& view, Contact* kept)
{
    std::vector<std::uint32_t> members;
    std::uint32_t count = 0;
    for (std::uint32_t i = piece.m_first; i < piece.m_last;)
    {
        const std::uint32_t end = slotEnd(&lists, lists.m_hits[i].m_slot);
        members.assign(lists.m_members + i, lists.m_members + end);
        std::sort(members.begin(), members.end(),
                  [&](std::uint32_t a, std::uint32_t b) { return isDeeper(&lists.m_hits[a], &lists.m_hits[b]) != 0; });
        members.resize(reduceSlot(&view, &lists, members.data(), end - i));
        std::sort(members.begin(), members.end());
        for (std::uint32_t member : members)
            kept[count++] = lists.m_hits[member];
        i = end;
    }
    piece.m_kept = count;
}
}  // namespace

void reduceOnHost(std::vector<Contact>& contacts, const ReductionView& view, std::size_t slotCount, ThreadTeam& threads)
{
    const std::uint32_t count = std::uint32_t(contacts.size());
    std::vector<std::uint32_t> members(count), first(slotCount, 0);
    std::iota(members.begin(), members.end(), 0u);
    for (std::uint32_t slot = 0, i = 0; slot < slotCount; ++slot)
    {
        first[slot] = i;
        while (i < count && contacts[i].m_slot == slot)
            ++i;
    }
    const SlotLists lists = {contacts.data(), members.data(), first.data(), std::uint32_t(slotCount), count};
    std::vector<Piece> pieces = piecesOf(lists);
    std::vector<Contact> all(count);
    runShared(threads, count >= kLeastShared, pieces.size(),
              [&](std::size_t i) { reducePiece(pieces[i], lists, view, all.data() + pieces[i].m_first); });
    std::size_t kept = 0;
    for (const Piece& piece : pieces)
    {
        std::copy_n(all.begin() + piece.m_first, piece.m_kept, all.begin() + std::ptrdiff_t(kept));
        kept += piece.m_kept;
    }
    all.resize(kept);
    contacts.swap(all);
}
}  // namespace drape
