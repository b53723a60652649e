// Numbers without rounding: sums of doubles that do not overlap; the last one determines the sign.
//
// Sums, differences and products are exact as long as no term leaves the range of a double. Products of three floats
// stay far inside, from 2^-447 for the smallest to 2^384 for the largest. Cost: quadratic in the number of terms; for
// predicates whose double filter did not decide. Method: J. R. Shewchuk, Adaptive precision floating-point arithmetic
// and fast robust geometric predicates, 1997.
#pragma once

#include <cmath>
#include <vector>

namespace drape
{
class Expansion
{
public:
    Expansion() = default;

    // a - b
    static Expansion difference(double a, double b)
    {
        Expansion result;
        result.add(a);
        result.add(-b);
        return result;
    }

    Expansion operator+(const Expansion& other) const
    {
        Expansion result = *this;
        for (double term : other.m_terms)
            result.add(term);
        return result;
    }
    Expansion operator-(const Expansion& other) const
    {
        Expansion result = *this;
        for (double term : other.m_terms)
            result.add(-term);
        return result;
    }
    Expansion operator*(const Expansion& other) const
    {
        Expansion result;
        for (double a : m_terms)
        {
            for (double b : other.m_terms)
            {
                const double product = a * b;
                result.add(std::fma(a, b, -product));
                result.add(product);
            }
        }
        return result;
    }

    int sign() const { return m_terms.empty() ? 0 : m_terms.back() > 0 ? 1 : -1; }

private:
    // Adds one double: each sum is carried on, each rounding error becomes a term (grow-expansion). Zeros are left out,
    // so the last term is the largest.
    void add(double carry)
    {
        std::size_t kept = 0;
        for (double term : m_terms)
        {
            const double sum = carry + term;
            const double back = sum - carry;
            const double error = (carry - (sum - back)) + (term - back);
            carry = sum;
            if (error != 0) m_terms[kept++] = error;
        }
        m_terms.resize(kept);
        if (carry != 0) m_terms.push_back(carry);
    }

    std::vector<double> m_terms;  // growing in size, none overlapping, none zero
};
}  // namespace drape
