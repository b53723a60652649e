// A plugin at namespace scope, which is made before main() begins. Ends with 1 if it has not started.
#include <cstdio>

#include <drape/drape.h>

static drape::Plugin plugin;

int main()
{
    std::puts(plugin.ready() ? plugin.report().c_str() : plugin.error().c_str());
    return plugin.ready() ? 0 : 1;
}
