// The app's floating-point environment around Drape's: modes and flags return as they were.
#include <gtest/gtest.h>

#include <cfenv>
#include <limits>

#include "bullet_plugin/core/float_environment.h"

#if defined(__x86_64__) || defined(_M_X64)
#include <xmmintrin.h>
#endif

namespace drape::test
{
namespace
{
volatile float g_zero = 0, g_one = 1, g_result = 0;
volatile long double g_longZero = 0, g_longOne = 1, g_longResult = 0;

void divideByZero()
{
    g_result = g_one / g_zero;
}

// Raises the flag of the older unit, on processors that have one.
void divideLongByZero()
{
    g_longResult = g_longOne / g_longZero;
}

// MinGW's fesetenv() leaves the register of SSE.
void reset()
{
    std::fesetenv(FE_DFL_ENV);
#if defined(__x86_64__) || defined(_M_X64)
    _mm_setcsr(0x1f80);
#endif
}

// Expects both units of the processor to round like the mode: MinGW's fegetround() queries the older one alone.
void expectRounding(int mode)
{
    EXPECT_EQ(std::fegetround(), mode);
    g_result = g_one + 1e-10f;
    EXPECT_EQ(g_result > 1, mode == FE_UPWARD);
    g_longResult = g_longOne + 1e-30L;
    EXPECT_EQ(g_longResult > 1, mode == FE_UPWARD);
}

class FloatEnvironment : public testing::Test
{
protected:
    FloatEnvironment() { reset(); }
    ~FloatEnvironment() override { reset(); }

    static int raised() { return std::fetestexcept(FE_ALL_EXCEPT); }
};
}  // namespace

TEST_F(FloatEnvironment, FlagsRaisedWithinVanish)
{
    {
        const DefaultFloats floats;
        divideByZero();
    }
    EXPECT_EQ(raised(), 0);
    {
        const DefaultFloats floats;
        divideLongByZero();
    }
    EXPECT_EQ(raised(), 0);
}

TEST_F(FloatEnvironment, FlagsRaisedBeforeStay)
{
    for (void (*const divide)() : {divideByZero, divideLongByZero})
    {
        reset();
        divide();
        const int before = raised();
        EXPECT_NE(before & FE_DIVBYZERO, 0);
        {
            const DefaultFloats floats;
            g_result = g_one / 3;
        }
        EXPECT_EQ(raised(), before);
    }
}

TEST_F(FloatEnvironment, FlagsOfTheAppsCodeWithinStay)
{
    for (void (*const divide)() : {divideByZero, divideLongByZero})
    {
        reset();
        {
            const DefaultFloats floats;
            g_result = g_one / 3;
            const CallersFloats callers;
            EXPECT_EQ(raised(), 0) << "the app sees none of Drape's";
            divide();
        }
        EXPECT_EQ(raised(), FE_DIVBYZERO);
    }
}

TEST_F(FloatEnvironment, ModesReturn)
{
    for (const int mode : {FE_TONEAREST, FE_UPWARD})
    {
        std::fesetround(mode);
        {
            const DefaultFloats floats;
            expectRounding(FE_TONEAREST);
            {
                const CallersFloats callers;
                expectRounding(mode);
            }
            expectRounding(FE_TONEAREST);
        }
        expectRounding(mode);
    }
}

// The app's code may change its modes for good.
TEST_F(FloatEnvironment, ModesThatTheAppsCodeSetsWithinStay)
{
    for (const int mode : {FE_UPWARD, FE_TONEAREST})
    {
        {
            const DefaultFloats floats;
            {
                const CallersFloats callers;
                std::fesetround(mode);
            }
            expectRounding(FE_TONEAREST);
        }
        expectRounding(mode);
    }
}

#if defined(__x86_64__) || defined(_M_X64)
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

TEST(FlushedNumbers, IsTheDefaultWithinAndTheCallersAfterwards)
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

TEST(FlushedNumbers, CodeThatIsCalledHasTheCallers)
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
#endif
}  // namespace drape::test
