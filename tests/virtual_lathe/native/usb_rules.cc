// SPDX-License-Identifier: Apache-2.0
// What the firmware must not do to the engine, by the data sheet or because it
// races with it.  Whatever is found goes to the list of mistakes.

#include "usb_engine.hh"
#include "usb_registers.hh"

#include <algorithm>

namespace lathe
{

namespace
{

// USB 2.0, section 9.2.6.3: the new address holds 2 ms after the status stage.
constexpr uint64_t ADDRESS_CYCLES = 2 * CYCLES_PER_MS;
// Erasing and writing a block of flash stops the core for some 4 ms; a
// transaction that was not looked at for longer is forgotten.
constexpr uint64_t PATIENCE_CYCLES = 20 * CYCLES_PER_MS;

} // namespace

void UsbEngine::mistake(const std::string &what)
{
    mistakes.add(what);
}

// ---- endpoints --------------------------------------------------------------

void UsbEngine::endpoint_changed(unsigned endpoint)
{
    uint8_t control = reg(UEP0 + endpoint);
    if (control & (EPINEN | EPOUTEN) && !(control & EPHSHK))
        mistake(text("endpoint %u gives no handshakes", endpoint));
    highest_ = 0;
    for (unsigned n = 0; n < ENDPOINTS; n++) {
        if (value(UEP0 + n) & (EPINEN | EPOUTEN))
            highest_ = n;
    }
}

// A SETUP found no room: right after a transaction the firmware may still be
// on its way, later it has forgotten to hand the descriptor over.
void UsbEngine::check_setup_refused()
{
    if (fifo_.empty() && !(reg(UCON) & PKTDIS) && !reset_seen_ &&
        chip().now() > last_pop_ + PATIENCE_CYCLES)
        mistake("SETUP not answered: no descriptor is ready for it");
}

void UsbEngine::check_refused()
{
    if (reg(UCON) & PKTDIS && chip().now() > last_setup_ + PATIENCE_CYCLES)
        mistake("PKTDIS is still set, long after the SETUP");
}

void UsbEngine::check_stall_handled(unsigned endpoint)
{
    // While STALLIF is up the firmware has not been told for long.
    bool pending =
        reg(UIR) & STALLIF && chip().now() <= last_stall_ + PATIENCE_CYCLES;
    if (reg(UEP0 + endpoint) & EPSTALL && !pending)
        mistake(
            text("endpoint %u: EPSTALL is still set after the halt", endpoint));
}

// A bus that wakes up just when the firmware goes to sleep wakes it again.
void UsbEngine::check_suspend()
{
    if (!idle_ && chip().now() > idle_end_ + PATIENCE_CYCLES)
        mistake("SUSPND set although the bus is not idle");
}

// ---- address ---------------------------------------------------------------

void UsbEngine::setup_seen(const std::vector<uint8_t> &data)
{
    last_setup_ = chip().now();
    set_address_open_ = data.size() >= 3 && data[0] == 0 && data[1] == 5;
    if (set_address_open_)
        wanted_address_ = data[2];
}

// The status stage of SET_ADDRESS is over.
void UsbEngine::expect_address()
{
    unsigned wanted = wanted_address_;
    granted_address_ = wanted;
    unsigned ticket = ++address_ticket_;
    chip().at(chip().now() + ADDRESS_CYCLES, [this, wanted, ticket] {
        if (ticket == address_ticket_ && reg(UADDR) != wanted)
            mistake(text("UADDR is %u and not %u, 2 ms after SET_ADDRESS",
                         reg(UADDR), wanted));
    });
}

// ---- dual-port RAM ----------------------------------------------------------

bool UsbEngine::buffer_fits(const Descriptor &d, unsigned count)
{
    unsigned first_free = RAM_FIRST + (highest_ + 1) * 2 * DESCRIPTOR_BYTES;
    if (d.address >= first_free && d.address + count <= RAM_LAST + 1)
        return true;
    mistake(text("descriptor 0x%03x: buffer 0x%03x + %u is outside "
                 "0x%03x..0x7FF",
                 d.at, d.address, count, first_free));
    return false;
}

// 1 = what the firmware does now cannot meet the engine.
bool UsbEngine::at_rest() const
{
    return !(value(UCON) & USBEN) || value(UCON) & (PKTDIS | SE0) ||
           reset_seen_;
}

bool UsbEngine::owned(unsigned address, std::string &what) const
{
    for (unsigned n = 0; n <= highest_; n++) {
        for (bool in : {false, true}) {
            if (!endpoint_on(n, in))
                continue;
            Descriptor d = descriptor(n, in);
            if (!(d.stat & UOWN))
                continue;
            const char *name = in ? "IN" : "OUT";
            if (address >= d.address && address < d.address + d.count) {
                what = text("buffer of endpoint %u %s", n, name);
                return true;
            }
            if (address > d.at && address < d.at + DESCRIPTOR_BYTES) {
                what = text("descriptor of endpoint %u %s", n, name);
                return true;
            }
        }
    }
    return false;
}

// Reading what the engine may be writing at that moment.
void UsbEngine::ram_read(unsigned address)
{
    if (at_rest())
        return;
    for (unsigned n = 0; n <= highest_; n++) {
        if (!endpoint_on(n, false))
            continue;
        Descriptor d = descriptor(n, false);
        if (d.stat & UOWN && !(d.stat & BSTALL) && address >= d.address &&
            address < d.address + d.count)
            mistake(text("0x%03x read while the engine owns it: buffer of "
                         "endpoint %u OUT",
                         address, n));
    }
}

void UsbEngine::armed(unsigned at, const Descriptor &d)
{
    if (d.stat & (KEN | INCDIS))
        mistake(text("descriptor 0x%03x: KEN or INCDIS is set", at));
    if (!(d.stat & (DTSEN | BSTALL)))
        mistake(text("descriptor 0x%03x: handed over without DTSEN", at));
    if (!buffer_fits(d, d.count))
        return;
    if (d.count > PACKET_MAX)
        mistake(text("descriptor 0x%03x: %u bytes are more than a packet", at,
                     d.count));
    for (unsigned slot = 0; slot <= highest_ * 2 + 1; slot++) {
        Descriptor other = descriptor(slot / 2, slot & 1);
        if (other.at == at || !(other.stat & UOWN) ||
            !endpoint_on(slot / 2, slot & 1))
            continue;
        if (d.address < other.address + other.count &&
            other.address < d.address + d.count)
            mistake(text("descriptor 0x%03x: its buffer is also that of 0x%03x",
                         at, other.at));
    }
}

void UsbEngine::ram_written(unsigned address, unsigned old_value,
                            unsigned value)
{
    if (!(reg(UCON) & USBEN))
        return;
    unsigned slot = (address - RAM_FIRST) / DESCRIPTOR_BYTES;
    bool stat = address % DESCRIPTOR_BYTES == 0 && slot < ENDPOINTS * 2 &&
                endpoint_on(slot / 2, slot & 1);
    if (stat) {
        if (old_value & UOWN && !at_rest())
            mistake(text("descriptor 0x%03x written (0x%02x -> 0x%02x) while "
                         "the engine owns it",
                         address, old_value, value));
        if (value & UOWN)
            armed(address, descriptor(slot / 2, slot & 1));
        return;
    }
    std::string what;
    if (!at_rest() && owned(address, what))
        mistake(text("0x%03x written while the engine owns it: ", address) +
                what);
}

} // namespace lathe
