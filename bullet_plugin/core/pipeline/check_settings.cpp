#include "check_settings.h"

#include <cmath>
#include <sstream>

namespace drape
{
namespace
{
struct Field
{
    const char* m_name;
    double m_value;
    bool m_good;
    const char* m_range;
};

bool isGroup(std::uint32_t size)
{
    return size >= 16 && size <= 256 && (size & (size - 1)) == 0;
}

// A value cast to an enumeration may be none of its enumerators.
template <typename Choice>
Field choice(const char* name, Choice value, Choice last)
{
    return {name, double(int(value)), int(value) >= 0 && int(value) <= int(last), "one of its enumerators"};
}
}  // namespace

bool checkSettings(const Settings& settings, Error& error)
{
    const Methods& methods = settings.m_methods;
    const TreeMethods& tree = methods.m_tree;
    const TopDownSettings& topDown = tree.m_topDown;
    const char* const group = "a power of two, 16 to 256";
    // NaN is in no range.
    const Field fields[] = {
        choice("Settings::m_backend", settings.m_backend, Backend::Host),
        choice("Settings::m_mode", settings.m_mode, ContactMode::Automatic),
        {"Settings::m_crossover", settings.m_crossover, !std::isnan(settings.m_crossover), "a number"},
        {"Settings::m_activation", double(settings.m_activation),
         settings.m_activation >= 0.0f && settings.m_activation <= 4.0f, "0 to 4"},
        {"Settings::m_threads", double(settings.m_threads), settings.m_threads <= 64, "0 to 64"},
        choice("Methods::m_traversal", methods.m_traversal, Traversal::WideGroups),
        choice("Methods::m_tree.m_builder", tree.m_builder, TreeBuilder::Ploc),
        choice("Methods::m_tree.m_refit", tree.m_refit, RefitMethod::Subtrees),
        choice("Methods::m_tree.m_workShape", tree.m_workShape, WorkShape::Serial),
        {"Methods::m_tree.m_mortonBits", double(tree.m_mortonBits), tree.m_mortonBits == 30 || tree.m_mortonBits == 63,
         "30 or 63"},
        {"Methods::m_tree.m_plocRadius", double(tree.m_plocRadius), tree.m_plocRadius >= 1 && tree.m_plocRadius <= 32,
         "1 to 32"},
        {"Methods::m_tree.m_topDown.m_leafSize", double(topDown.m_leafSize), topDown.m_leafSize >= 1, "1 or more"},
        {"Methods::m_tree.m_topDown.m_groupSize", double(topDown.m_groupSize), isGroup(topDown.m_groupSize), group},
        {"Methods::m_tree.m_topDown.m_smallShare", double(topDown.m_smallShare), topDown.m_smallShare >= 0.0f,
         "0 or more"},
        {"Methods::m_tree.m_topDown.m_largeSize", double(topDown.m_largeSize), topDown.m_largeSize >= 1, "1 or more"},
        {"Methods::m_tree.m_topDown.m_compactionGroup", double(topDown.m_compactionGroup),
         isGroup(topDown.m_compactionGroup), group},
        {"Methods::m_rebuildDecay", double(methods.m_rebuildDecay),
         methods.m_rebuildDecay == 0.0f || methods.m_rebuildDecay >= 1.0f, "0 (never), or 1 or more"}};
    for (const Field& field : fields)
    {
        if (field.m_good) continue;
        std::ostringstream call;
        call << field.m_name << " is " << field.m_value;
        error.m_call = call.str();
        error.m_detail = std::string("it should be ") + field.m_range;
        return false;
    }
    return true;
}
}  // namespace drape
