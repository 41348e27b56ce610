// SPDX-License-Identifier: Apache-2.0
// Differences between gpsim releases, met by asking the compiler what the
// installed one has: the blocking flag of INTCON, and whether the watchdog is
// a member or a pointer.

#ifndef VIRTUAL_LATHE_GPSIM_VERSIONS_HH
#define VIRTUAL_LATHE_GPSIM_VERSIONS_HH

namespace lathe
{

template <typename Intcon>
auto allow_nesting(Intcon &intcon, int)
    -> decltype(static_cast<void>(intcon.in_interrupt = false))
{
    intcon.in_interrupt = false;
}

template <typename Intcon> void allow_nesting(Intcon &, long)
{
    // This release has no such flag.
}

template <typename Watchdog> void switch_off(Watchdog &watchdog)
{
    watchdog.initialize(false);
}

template <typename Watchdog> void switch_off(Watchdog *watchdog)
{
    watchdog->initialize(false);
}

} // namespace lathe

#endif
