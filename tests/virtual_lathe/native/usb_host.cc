// SPDX-License-Identifier: Apache-2.0
// Full speed is 12 Mbit/s and the core runs at 12 MIPS, so a bit time is an
// instruction cycle.  Transactions do not cross the end of a frame.

#include "pins.hh"
#include "usb_host.hh"
#include "virtual_lathe.h"

#include <algorithm>

namespace lathe
{

namespace
{

constexpr int VBUS_PIN = B + 6;
// Bits on the wire: sync 8, PID 8, address and CRC 16, end 3; data packets
// carry 16 bits of CRC; a turn-around of the bus is about 8 bits.
constexpr uint64_t TOKEN_BITS = 35, DATA_BITS = 35, HANDSHAKE_BITS = 19;
constexpr uint64_t TURN_BITS = 8, GAP_BITS = 24, TIMEOUT_BITS = 18;
constexpr uint64_t LONGEST_BITS =
    TOKEN_BITS + DATA_BITS + 64 * 8 + HANDSHAKE_BITS + 3 * TURN_BITS + GAP_BITS;
constexpr uint64_t BULK_PAUSE = 720; // 60 us after a NAK
constexpr uint64_t NOTIFY_PAUSE = 16 * CYCLES_PER_MS;
constexpr uint64_t IDLE_CYCLES = 3 * CYCLES_PER_MS;

uint64_t bits(Handshake answer, size_t bytes)
{
    switch (answer) {
    case Handshake::Ack:
        return TOKEN_BITS + DATA_BITS + 8 * bytes + HANDSHAKE_BITS +
               2 * TURN_BITS;
    case Handshake::None:
        return TOKEN_BITS + DATA_BITS + 8 * bytes + TIMEOUT_BITS;
    default:
        return TOKEN_BITS + HANDSHAKE_BITS + TURN_BITS;
    }
}

} // namespace

UsbHost &usb_host()
{
    static UsbHost instance;
    return instance;
}

void UsbHost::attach()
{
    usb_engine().attach();
    pins().drive(VBUS_PIN, VL_LOW);
    frame_start_ = chip().now();
    frame();
}

void UsbHost::plug(bool in)
{
    plugged_ = in;
    frames_on_ = in;
    idle_since_ = chip().now();
    idle_told_ = false;
    pins().drive(VBUS_PIN, in ? VL_HIGH : VL_LOW);
    if (!in) {
        resetting_ = false;
        busy_ = false;
        generation_++;
        close();
        if (waiting_) {
            waiting_ = false;
            done_ = true;
            result = Handshake::None;
            chip().stop(VL_STOP_EVENT);
        }
    }
}

void UsbHost::drive_reset(bool active)
{
    resetting_ = active;
    if (plugged_)
        usb_engine().bus_reset(active);
    if (active)
        close();
}

void UsbHost::suspend(bool on)
{
    frames_on_ = !on && plugged_;
    idle_since_ = chip().now();
    idle_told_ = false;
    if (!on && plugged_)
        usb_engine().bus_activity();
}

void UsbHost::frame()
{
    uint64_t now = chip().now();
    frame_start_ += CYCLES_PER_MS;
    while (frame_start_ <= now)
        frame_start_ += CYCLES_PER_MS;
    chip().at(frame_start_, [this] { frame(); });
    if (!frames_on_ || resetting_) {
        if (!idle_told_ && !resetting_ && now - idle_since_ >= IDLE_CYCLES) {
            idle_told_ = true;
            usb_engine().bus_idle();
        }
        return;
    }
    counts.frames++;
    frame_number_ = (frame_number_ + 1) & 0x7FF;
    usb_engine().start_of_frame(frame_number_);
    schedule(now + TOKEN_BITS);
}

void UsbHost::schedule(uint64_t cycle)
{
    unsigned ticket = ++generation_;
    chip().at(cycle, [this, ticket] {
        if (ticket == generation_)
            step();
    });
}

void UsbHost::submit(const Packet &wanted)
{
    packet = wanted;
    done_ = false;
    waiting_ = true;
    if (!plugged_ || !frames_on_) {
        waiting_ = false;
        done_ = true;
        result = Handshake::None;
        return;
    }
    if (!busy_)
        schedule(chip().now() + GAP_BITS);
}

void UsbHost::open(unsigned address, unsigned in, unsigned out, unsigned notify)
{
    address_ = address;
    in_ = Pipe();
    out_ = Pipe();
    notify_ = Pipe();
    in_.on = out_.on = true;
    in_.endpoint = in;
    out_.endpoint = out;
    in_.pause = out_.pause = BULK_PAUSE;
    notify_.on = notify != 0;
    notify_.endpoint = notify;
    notify_.pause = NOTIFY_PAUSE;
}

void UsbHost::close()
{
    in_.on = out_.on = notify_.on = false;
    to_device.clear();
}

Packet UsbHost::in_token(const Pipe &pipe) const
{
    Packet packet;
    packet.token = Token::In;
    packet.address = address_;
    packet.endpoint = pipe.endpoint;
    return packet;
}

// Picks the next transaction that is due; otherwise says when to look again.
bool UsbHost::choose()
{
    uint64_t now = chip().now();
    if (waiting_) {
        owner_ = Owner::Test;
        current_ = packet;
        return true;
    }
    bool in = in_.on && !in_.stalled && from_device.size() < receive_limit;
    bool out = out_.on && !out_.stalled && !to_device.empty();
    bool in_due = in && in_.next_try <= now;
    bool out_due = out && out_.next_try <= now;
    if (notify_.on && !notify_.stalled && notify_.next_try <= now) {
        owner_ = Owner::Notify;
        current_ = in_token(notify_);
    } else if (in_due && (!out_due || !last_was_in_)) {
        owner_ = Owner::In;
        current_ = in_token(in_);
    } else if (out_due) {
        owner_ = Owner::Out;
        size_t count = std::min<size_t>(out_.packet, to_device.size());
        current_ = {Token::Out,
                    address_,
                    out_.endpoint,
                    out_.toggle,
                    {to_device.begin(), to_device.begin() + count},
                    !out_.repeated};
    } else {
        uint64_t next = frame_start_;
        if (in)
            next = std::min(next, in_.next_try);
        if (out)
            next = std::min(next, out_.next_try);
        schedule(std::max(next, now + GAP_BITS));
        return false;
    }
    last_was_in_ = owner_ == Owner::In;
    return true;
}

void UsbHost::step()
{
    if (busy_ || !plugged_ || !frames_on_ || resetting_)
        return;
    // frame_start_ is the start of the next frame; its own event comes then.
    if (chip().now() + LONGEST_BITS > frame_start_)
        return;
    if (choose())
        transfer();
}

void UsbHost::transfer()
{
    busy_ = true;
    counts.transactions++;
    answer_ = usb_engine().begin(current_);
    unsigned ticket = ++generation_;
    chip().at(chip().now() + bits(answer_, current_.data.size()),
              [this, ticket] {
                  if (ticket == generation_)
                      finish();
              });
}

void UsbHost::finish()
{
    busy_ = false;
    bool in = current_.token == Token::In;
    bool lost = answer_ == Handshake::Ack && lose_handshakes;
    if (lost)
        lose_handshakes--;
    // A lost handshake: for IN the engine misses our ACK and keeps the
    // packet; for OUT it has the data and only we do not know.
    if (answer_ == Handshake::Ack && !(in && lost))
        usb_engine().complete(current_);
    if (in && lost) {
        usb_engine().host_error();
        unacknowledged_ = true;
    }
    if (lost && !in)
        answer_ = Handshake::None;
    counts.naks += answer_ == Handshake::Nak;
    counts.stalls += answer_ == Handshake::Stall;
    counts.timeouts += answer_ == Handshake::None;
    if (owner_ == Owner::Test) {
        waiting_ = false;
        done_ = true;
        result = answer_;
        packet = current_;
        chip().stop(VL_STOP_EVENT);
    } else {
        finish_pipe(owner_ == Owner::In    ? in_
                    : owner_ == Owner::Out ? out_
                                           : notify_);
    }
    if (!waiting_ || owner_ != Owner::Test)
        schedule(chip().now() + GAP_BITS);
}

void UsbHost::finish_pipe(Pipe &pipe)
{
    if (answer_ == Handshake::Stall) {
        pipe.stalled = true;
    } else if (answer_ != Handshake::Ack) {
        pipe.repeated = pipe.repeated || answer_ == Handshake::None;
        pipe.next_try = chip().now() + pipe.pause;
    } else if (&pipe == &out_) {
        to_device.erase(to_device.begin(),
                        to_device.begin() + current_.data.size());
        counts.bytes_out += current_.data.size();
        pipe.toggle ^= 1;
        pipe.repeated = false;
    } else if (take_in(pipe, &pipe == &in_ ? from_device : notifications)) {
        counts.bytes_in += current_.data.size();
    }
    if (&pipe == &notify_)
        pipe.next_try = chip().now() + pipe.pause;
}

// A packet with the old toggle is one we have already: drop it.
bool UsbHost::take_in(Pipe &pipe, std::deque<uint8_t> &sink)
{
    if (current_.toggle != pipe.toggle) {
        counts.wrong_toggles++;
        if (!unacknowledged_)
            usb_engine().mistake("IN packet with the wrong data toggle");
        unacknowledged_ = false;
        return false;
    }
    sink.insert(sink.end(), current_.data.begin(), current_.data.end());
    pipe.toggle ^= 1;
    return true;
}

} // namespace lathe
