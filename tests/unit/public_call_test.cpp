// Exceptions that end a public function: each kind becomes a failure of its own, and none crosses the interface.
#include "bullet_plugin/core/public_call.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

namespace drape::test
{
namespace
{
// Returns how the work ended: empty without an exception, else the kind and the text of the failure.
std::string endOf(const std::function<void()>& work)
{
    std::string end;
    guarded(work, [&](const CaughtException& caught)
            { end = std::string(caught.m_isMemory ? "memory: " : "fault: ") + caught.m_text; });
    return end;
}
}  // namespace

TEST(PublicCall, EveryExceptionBecomesAFailure)
{
    EXPECT_EQ(endOf([] {}), "");
    EXPECT_EQ(endOf([] { throw std::bad_alloc(); }), "memory: out of memory");
    EXPECT_EQ(endOf([] { throw std::length_error("vector"); }), "memory: out of memory");
    EXPECT_EQ(endOf([] { throw std::runtime_error("the reason"); }), "fault: the reason");
    EXPECT_EQ(endOf([] { throw 7; }), "fault: unknown exception");
}

TEST(PublicCall, AValueReplacesTheResultOfAFailure)
{
    EXPECT_EQ(guardedOr(1, [] { return 2; }), 2);
    EXPECT_EQ(guardedOr(1, []() -> int { throw std::bad_alloc(); }), 1);
    EXPECT_EQ(guardedOr(1, []() -> int { throw 7; }), 1);
}

TEST(PublicCall, AnErrorNamesTheCallAndTheReason)
{
    Error error;
    setError(error, "the call", CaughtException{false, "the reason"});
    EXPECT_EQ(error.text(), "the call\nthe reason");
}
}  // namespace drape::test
