// Drape's own floating-point environment, and the caller's afterwards.
#include "bullet_plugin/core/float_environment.h"

#include <cfenv>
#include <limits>

#include <gtest/gtest.h>

#if defined(__x86_64__) || defined(_M_X64)
#include <xmmintrin.h>

namespace drape::test
{
namespace
{
// The bits of MXCSR that flush results and inputs to zero.
constexpr unsigned kFlushes = 0x8040;

// Returns false if the thread flushes subnormal numbers to zero.
bool keepsSubnormals()
{
    volatile float smallest = std::numeric_limits<float>::min();
    smallest = smallest / 4;
    return smallest > 0;
}

// Flushes subnormal numbers while it lives, and rounds upwards.
class OddFloats
{
public:
    OddFloats() : m_before(_mm_getcsr())
    {
        std::fesetround(FE_UPWARD);
        _mm_setcsr(_mm_getcsr() | kFlushes);
    }
    ~OddFloats()
    {
        std::fesetround(FE_TONEAREST);
        _mm_setcsr(m_before);
    }

private:
    unsigned m_before;
};

TEST(FloatEnvironment, IsTheDefaultWithinAndTheCallersAfterwards)
{
    const OddFloats odd;
    const unsigned before = _mm_getcsr();
    ASSERT_FALSE(keepsSubnormals());
    {
        const DefaultFloats defaults;
        EXPECT_TRUE(keepsSubnormals());
        EXPECT_EQ(_mm_getcsr() & 0xffc0u, 0x1f80u) << "rounding, traps and flushing are the processor's defaults";
        const DefaultFloats nested;
        EXPECT_TRUE(keepsSubnormals());
    }
    EXPECT_FALSE(keepsSubnormals());
    EXPECT_EQ(_mm_getcsr() & 0xffc0u, before & 0xffc0u);
}

TEST(FloatEnvironment, CodeThatIsCalledHasTheCallers)
{
    const OddFloats odd;
    const DefaultFloats defaults;
    {
        const CallersFloats callers;
        EXPECT_FALSE(keepsSubnormals());
    }
    EXPECT_TRUE(keepsSubnormals());
}
}  // namespace
}  // namespace drape::test
#endif
