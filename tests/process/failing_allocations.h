// Makes allocations of operator new fail, one after the other, in a program that links failing_allocations.cpp.
#pragma once

namespace drape::test
{
// Makes an allocation fail during its lifetime: the one with the given number, counted from 0 over all threads, throws
// std::bad_alloc. Optionally all later allocations fail, too.
class FailingAllocations
{
public:
    enum class Which
    {
        One,
        AllFromThere
    };

    explicit FailingAllocations(long number, Which which = Which::One);
    ~FailingAllocations();
    FailingAllocations(const FailingAllocations&) = delete;
    FailingAllocations& operator=(const FailingAllocations&) = delete;

    // Returns true if the failing allocation was reached.
    static bool hasFailed();
};
}  // namespace drape::test
