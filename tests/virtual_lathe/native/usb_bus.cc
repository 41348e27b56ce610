// SPDX-License-Identifier: Apache-2.0
// The engine as the bus sees it: answers to tokens, frames, reset, idle.

#include "usb_engine.hh"
#include "usb_registers.hh"

namespace lathe
{

Handshake UsbEngine::begin(Packet &packet)
{
    unsigned n = packet.endpoint;
    if (!connected() || packet.address != reg(UADDR) || reg(UCON) & SUSPND)
        return Handshake::None;
    uint8_t control = reg(UEP0 + n);
    bool in = packet.token == Token::In;
    if (!(control & (in ? EPINEN : EPOUTEN)))
        return Handshake::None;
    if (packet.token == Token::Setup) {
        bool ready = !(control & EPCONDIS) &&
                     fifo_.size() < STATUS_FIFO_DEPTH &&
                     descriptor(n, false).stat & UOWN;
        if (!ready && n == 0)
            check_setup_refused();
        return ready ? Handshake::Ack : Handshake::None;
    }
    Descriptor d = descriptor(n, in);
    if (reg(UCON) & PKTDIS || fifo_.size() >= STATUS_FIFO_DEPTH ||
        !(d.stat & UOWN)) {
        check_refused();
        return Handshake::Nak;
    }
    if (d.stat & BSTALL) {
        reg(UEP0 + n) |= EPSTALL;
        raise(STALLIF);
        last_stall_ = chip().now();
        return Handshake::Stall;
    }
    check_stall_handled(n);
    if (in) {
        packet.toggle = d.stat & DTS ? 1 : 0;
        packet.data.clear();
        if (buffer_fits(d, d.count)) {
            for (unsigned i = 0; i < d.count; i++)
                packet.data.push_back(ram(d.address + i));
        }
    }
    return Handshake::Ack;
}

void UsbEngine::complete(const Packet &packet)
{
    bool in = packet.token == Token::In;
    unsigned n = packet.endpoint;
    Descriptor d = descriptor(n, in);
    if (!(d.stat & UOWN) || reg(UCON) & SE0)
        return;
    unsigned count = packet.data.size();
    if (!in) {
        // Table 17-3: a packet with the wrong toggle is acknowledged and lost.
        bool wrong =
            d.stat & DTSEN && packet.toggle != (d.stat & DTS ? 1u : 0u);
        if (wrong && packet.token == Token::Out) {
            if (packet.fresh)
                mistake(text("descriptor 0x%03x drops a new packet: its "
                             "data toggle is wrong",
                             d.at));
            return;
        }
        if (count > d.count) {
            mistake(text("descriptor 0x%03x: packet of %u bytes for a buffer "
                         "of %u",
                         d.at, count, d.count));
            count = d.count;
        }
        if (buffer_fits(d, count)) {
            for (unsigned i = 0; i < count; i++)
                set_ram(d.address + i, packet.data[i]);
        }
    }
    if (packet.token == Token::Setup) {
        reg(UCON) |= PKTDIS;
        setup_seen(packet.data);
    } else if (in && n == 0 && set_address_open_) {
        set_address_open_ = false;
        expect_address();
    }
    write_back(d, packet.token, count);
    push_status(n << 3 | (in ? 4 : 0));
}

void UsbEngine::start_of_frame(unsigned number)
{
    bus_activity();
    reg(UFRML) = number & 0xFF;
    reg(UFRMH) = number >> 8 & 7;
    if (connected() && !(reg(UCON) & SUSPND))
        raise(SOFIF);
}

void UsbEngine::bus_reset(bool active)
{
    if (!(reg(UCON) & USBEN))
        return;
    bus_activity();
    if (!active) {
        reg(UCON) &= ~SE0;
        return;
    }
    reg(UCON) |= SE0;
    reg(UCON) &= ~PKTDIS;
    reg(UADDR) = 0;
    set_address_open_ = false;
    wanted_address_ = granted_address_ = NO_ADDRESS;
    address_ticket_++;
    reset_seen_ = true;
    raise(URSTIF);
}

void UsbEngine::bus_idle()
{
    idle_ = true;
    if (connected())
        raise(IDLEIF);
}

void UsbEngine::bus_activity()
{
    if (idle_)
        idle_end_ = chip().now();
    idle_ = false;
    if (connected() && reg(UCON) & SUSPND)
        raise(ACTVIF);
}

} // namespace lathe
