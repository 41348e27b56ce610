// SPDX-License-Identifier: Apache-2.0
// The keys of the panel: a ladder of resistors that makes a voltage on RA0.

#ifndef VIRTUAL_LATHE_KEYS_HH
#define VIRTUAL_LATHE_KEYS_HH

#include "pins.hh"

namespace lathe
{

class Keys
{
public:
    void attach();
    // Bit k: key k is pressed.  Contacts bounce as the switches do.
    void hold(unsigned keys);

private:
    double aim() const;
    double source_ohm() const;
    void advance();
    void refresh();
    void set_contacts(unsigned contacts);
    void bounce();

    unsigned wanted_ = 0;   // keys held by the hand
    unsigned bouncing_ = 0; // those that have just changed
    unsigned contacts_ = 0; // closed at this moment
    uint64_t bounce_end_ = 0;
    unsigned ticket_ = 0;
    double volts_ = 0; // on the capacitor, at cycle since_
    uint64_t since_ = 0;
};

Keys &keys();

} // namespace lathe

#endif
