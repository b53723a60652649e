#include "tests/support/moving_soup.h"

#include <limits>

#include "scenes/shapes.h"

namespace drape::test
{
Side makeMovingSoup(int count, std::uint32_t seed)
{
    Random random(seed);
    Side side = makeSide({makeSoup(1.0f, 0.1f, count, seed)});
    disturb(side.m_end, 0.1f, random);
    return side;
}

void spoil(std::vector<float>& positions, Random& random)
{
    const float bad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e38f,
                         1e-40f};
    for (std::size_t i = 0; i < positions.size() / 50 + 1; ++i)
        positions[random.below(std::uint32_t(positions.size()))] = bad[random.below(4)];
}
}  // namespace drape::test
