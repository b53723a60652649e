// Vectors of lanes in C++, as vector types of GCC and Clang: the base of lanes.h in the host's kernels, and the mask
// functions for simd_group.h. Included by lanes.h, within its namespace.
//
// A vector that is wider than the CPU's registers is a pair of halves, and so on: compilers compute comparisons and
// selections of such types one lane after the other.
#ifndef DRAPE_LIB_HOST_LANES_H
#define DRAPE_LIB_HOST_LANES_H

#if defined(__AVX512F__)
#define DRAPE_REGISTER_LANES 16
#elif defined(__AVX__)
#define DRAPE_REGISTER_LANES 8
#else
#define DRAPE_REGISTER_LANES 4
#endif
typedef float RegisterLanes __attribute__((vector_size(4 * DRAPE_REGISTER_LANES)));
typedef int RegisterMask __attribute__((vector_size(4 * DRAPE_REGISTER_LANES)));

template <class Half>
struct Pair
{
    Half m_low, m_high;
};
#if DRAPE_LANES == DRAPE_REGISTER_LANES
typedef RegisterLanes Lanes;
typedef RegisterMask LaneMask;
#elif DRAPE_LANES == 2 * DRAPE_REGISTER_LANES
typedef Pair<RegisterLanes> Lanes;
typedef Pair<RegisterMask> LaneMask;
#else
typedef Pair<Pair<RegisterLanes> > Lanes;
typedef Pair<Pair<RegisterMask> > LaneMask;
#endif

// Defines an operator of two pairs, and of a pair and a number.
#define DRAPE_PAIR_OPERATOR(op)                                                              \
    template <class Half>                                                                    \
    DRAPE_FUNCTION auto operator op(Pair<Half> a, Pair<Half> b)                              \
    {                                                                                        \
        return Pair<decltype(a.m_low op b.m_low)>{a.m_low op b.m_low, a.m_high op b.m_high}; \
    }                                                                                        \
    template <class Half, class Number>                                                      \
    DRAPE_FUNCTION auto operator op(Pair<Half> a, Number b)                                  \
    {                                                                                        \
        return Pair<decltype(a.m_low op b)>{a.m_low op b, a.m_high op b};                    \
    }                                                                                        \
    template <class Half, class Number>                                                      \
    DRAPE_FUNCTION auto operator op(Number a, Pair<Half> b)                                  \
    {                                                                                        \
        return Pair<decltype(a op b.m_low)>{a op b.m_low, a op b.m_high};                    \
    }
DRAPE_PAIR_OPERATOR(+)
DRAPE_PAIR_OPERATOR(-)
DRAPE_PAIR_OPERATOR(*)
DRAPE_PAIR_OPERATOR(/)
DRAPE_PAIR_OPERATOR(<)
DRAPE_PAIR_OPERATOR(<=)
DRAPE_PAIR_OPERATOR(>)
DRAPE_PAIR_OPERATOR(>=)
DRAPE_PAIR_OPERATOR(==)
DRAPE_PAIR_OPERATOR(!=)
#undef DRAPE_PAIR_OPERATOR

// Defines a bitwise operator of two masks, and its assignment.
#define DRAPE_PAIR_BITS(op)                                                \
    template <class Half>                                                  \
    DRAPE_FUNCTION Pair<Half> operator op(Pair<Half> a, Pair<Half> b)      \
    {                                                                      \
        return {a.m_low op b.m_low, a.m_high op b.m_high};                 \
    }                                                                      \
    template <class Half>                                                  \
    DRAPE_FUNCTION Pair<Half>& operator op##=(Pair<Half>& a, Pair<Half> b) \
    {                                                                      \
        return a = a op b;                                                 \
    }
DRAPE_PAIR_BITS(&)
DRAPE_PAIR_BITS(|)
#undef DRAPE_PAIR_BITS

template <class Half>
DRAPE_FUNCTION Pair<Half> operator-(Pair<Half> a)
{
    return {-a.m_low, -a.m_high};
}
template <class Half>
DRAPE_FUNCTION Pair<Half> operator~(Pair<Half> a)
{
    return {~a.m_low, ~a.m_high};
}
template <class Half, class Other>
DRAPE_FUNCTION Pair<Half>& operator+=(Pair<Half>& a, Other b)
{
    return a = a + b;
}
template <class Half, class Other>
DRAPE_FUNCTION Pair<Half>& operator-=(Pair<Half>& a, Other b)
{
    return a = a - b;
}

// Functions of one register, and of pairs.
DRAPE_FUNCTION void fillLanes(RegisterLanes* lanes, float a)
{
    *lanes = a - RegisterLanes{};
}
DRAPE_FUNCTION void fillLanes(RegisterMask* mask, int a)
{
    *mask = RegisterMask{} + a;
}
template <class Half, class Number>
DRAPE_FUNCTION void fillLanes(Pair<Half>* pair, Number a)
{
    fillLanes(&pair->m_low, a);
    fillLanes(&pair->m_high, a);
}

template <class Register, class Number>
DRAPE_FUNCTION void loadLanes(Register* lanes, const Number* from)
{
    __builtin_memcpy(lanes, from, sizeof *lanes);
}
template <class Half, class Number>
DRAPE_FUNCTION void loadLanes(Pair<Half>* pair, const Number* from)
{
    loadLanes(&pair->m_low, from);
    loadLanes(&pair->m_high, from + sizeof(Half) / sizeof(Number));
}

template <class Register>
DRAPE_FUNCTION void storeLanes(Register lanes, float* to)
{
    __builtin_memcpy(to, &lanes, sizeof lanes);
}
template <class Half>
DRAPE_FUNCTION void storeLanes(Pair<Half> pair, float* to)
{
    storeLanes(pair.m_low, to);
    storeLanes(pair.m_high, to + sizeof(Half) / sizeof(float));
}

DRAPE_FUNCTION RegisterLanes chosen(RegisterMask mask, RegisterLanes yes, RegisterLanes no)
{
    return mask ? yes : no;
}
template <class Mask, class Half>
DRAPE_FUNCTION Pair<Half> chosen(Pair<Mask> mask, Pair<Half> yes, Pair<Half> no)
{
    return {chosen(mask.m_low, yes.m_low, no.m_low), chosen(mask.m_high, yes.m_high, no.m_high)};
}

DRAPE_FUNCTION RegisterLanes lanesAbs(RegisterLanes a)
{
    return (RegisterLanes)((RegisterMask)a & 0x7fffffff);
}
template <class Half>
DRAPE_FUNCTION Pair<Half> lanesAbs(Pair<Half> a)
{
    return {lanesAbs(a.m_low), lanesAbs(a.m_high)};
}

DRAPE_FUNCTION RegisterLanes drapeSqrt(RegisterLanes a)
{
    RegisterLanes root;
    for (int i = 0; i < DRAPE_REGISTER_LANES; ++i)
        root[i] = __builtin_sqrtf(a[i]);
    return root;
}
template <class Half>
DRAPE_FUNCTION Pair<Half> drapeSqrt(Pair<Half> a)
{
    return {drapeSqrt(a.m_low), drapeSqrt(a.m_high)};
}

// Stores one byte per lane of a mask.
DRAPE_FUNCTION void storeBytes(RegisterMask mask, signed char* bytes)
{
    typedef signed char Bytes __attribute__((vector_size(DRAPE_REGISTER_LANES)));
    const Bytes all = __builtin_convertvector(mask, Bytes);
    __builtin_memcpy(bytes, &all, sizeof all);
}
template <class Half>
DRAPE_FUNCTION void storeBytes(Pair<Half> mask, signed char* bytes)
{
    storeBytes(mask.m_low, bytes);
    storeBytes(mask.m_high, bytes + sizeof(Half) / sizeof(int));
}

// The words of lanes.h.
DRAPE_FUNCTION Lanes lanesSplat(float a)
{
    Lanes lanes;
    fillLanes(&lanes, a);
    return lanes;
}
DRAPE_FUNCTION Lanes lanesSplat(Lanes a)
{
    return a;
}
DRAPE_FUNCTION LaneMask lanesMaskSplat(int a)
{
    LaneMask mask;
    fillLanes(&mask, -a);
    return mask;
}
DRAPE_FUNCTION LaneMask lanesNot(LaneMask mask)
{
    return ~mask;
}
DRAPE_FUNCTION Lanes lanesLoad(const float* block, DRAPE_UINT component)
{
    Lanes lanes;
    loadLanes(&lanes, block + DRAPE_LANES * component);
    return lanes;
}
DRAPE_FUNCTION void lanesStore(Lanes lanes, float* block, DRAPE_UINT component)
{
    storeLanes(lanes, block + DRAPE_LANES * component);
}
DRAPE_FUNCTION LaneMask lanesLoadIds(const DRAPE_UINT* rows, DRAPE_UINT row)
{
    LaneMask ids;
    loadLanes(&ids, rows + DRAPE_LANES * row);
    return ids;
}
DRAPE_FUNCTION Lanes lanesSelect(LaneMask mask, Lanes yes, Lanes no)
{
    return chosen(mask, yes, no);
}
DRAPE_FUNCTION Lanes lanesSelect(LaneMask mask, Lanes yes, float no)
{
    return chosen(mask, yes, lanesSplat(no));
}
DRAPE_FUNCTION Lanes lanesMax(Lanes a, Lanes b)
{
    return chosen(a < b, b, a);
}
DRAPE_FUNCTION Lanes lanesMin(Lanes a, Lanes b)
{
    return chosen(b < a, b, a);
}
DRAPE_FUNCTION Lanes lanesSqrt(Lanes a)
{
    return drapeSqrt(a);
}
DRAPE_FUNCTION void laneBytes(LaneMask mask, DRAPE_ULONG* bytes)
{
    storeBytes(mask, (signed char*)bytes);
}

#endif
