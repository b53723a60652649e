// The answers to the question which members of a step may meet, two by two, as far as it was asked.
//
// Threads may mark pairs, note rows and read answers side by side. One thread sets the answers. Cost: a byte for each
// two members, cleared in every step.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>

namespace drape
{
class MeetingAnswers
{
public:
    void clear(std::size_t members)
    {
        if (members != m_members) m_answers.reset(new Cell[members * members]);
        if (members != m_members) m_hasRow.reset(new Cell[members]);
        m_members = members;
        for (std::size_t i = 0; i < members * members; ++i)
            m_answers[i].store(kUnknown, std::memory_order_relaxed);
        for (std::size_t i = 0; i < members; ++i)
            m_hasRow[i].store(0, std::memory_order_relaxed);
    }
    void set(std::size_t a, std::size_t b, bool yes) { store(a, b, yes ? kYes : kNo); }
    bool isKnown(std::size_t a, std::size_t b) const { return load(a, b) >= kNo; }
    bool isYes(std::size_t a, std::size_t b) const { return load(a, b) == kYes; }
    // Marks a pair that has to be asked.
    void mark(std::size_t a, std::size_t b)
    {
        if (load(a, b) == kUnknown) store(a, b, kMarked);
    }
    bool isMarked(std::size_t a, std::size_t b) const { return load(a, b) == kMarked; }
    // Notes a contact that two members have.
    void noteRow(std::size_t a, std::size_t b)
    {
        for (const std::size_t member : {a, b})
            if (!hasRows(member)) m_hasRow[member].store(1, std::memory_order_relaxed);
    }
    bool hasRows(std::size_t member) const { return m_hasRow[member].load(std::memory_order_relaxed) != 0; }

private:
    using Cell = std::atomic<unsigned char>;
    static constexpr unsigned char kUnknown = 0, kMarked = 1, kNo = 2, kYes = 3;

    unsigned char load(std::size_t a, std::size_t b) const
    {
        return m_answers[a * m_members + b].load(std::memory_order_relaxed);
    }
    void store(std::size_t a, std::size_t b, unsigned char answer)
    {
        m_answers[a * m_members + b].store(answer, std::memory_order_relaxed);
    }

    std::size_t m_members = 0;
    std::unique_ptr<Cell[]> m_answers;  // by two members
    std::unique_ptr<Cell[]> m_hasRow;   // by member
};
}  // namespace drape
