// SPDX-License-Identifier: Apache-2.0
// The host's side of the cable: frames, single transactions for tests and
// for the enumeration, and the steady traffic of an open serial port.

#ifndef VIRTUAL_LATHE_USB_HOST_HH
#define VIRTUAL_LATHE_USB_HOST_HH

#include "usb_engine.hh"

#include <deque>

namespace lathe
{

// Traffic of one direction of the CDC port.
struct Pipe {
    bool on = false;
    unsigned endpoint = 0;
    unsigned toggle = 0;
    unsigned packet = 64;
    uint64_t next_try = 0;
    uint64_t pause = 0; // cycles to the next try after a NAK
    bool stalled = false;
    bool repeated = false; // the packet to send may have arrived already
};

class UsbHost
{
public:
    void attach();
    void plug(bool in);
    bool plugged() const
    {
        return plugged_;
    }
    void drive_reset(bool active);
    void suspend(bool on);

    // One transaction, as soon as the bus is free; stops the chip when over.
    void submit(const Packet &packet);
    bool done() const
    {
        return done_;
    }
    Handshake result = Handshake::None;
    Packet packet;

    void open(unsigned address, unsigned in, unsigned out, unsigned notify);
    void close();
    std::deque<uint8_t> to_device, from_device, notifications;
    size_t receive_limit = 4096; // bytes unread before polling stops

    unsigned lose_handshakes = 0; // fault: the next n are lost on the bus
    struct Counts {
        uint64_t frames, transactions, naks, stalls, timeouts, bytes_in,
            bytes_out, wrong_toggles;
    } counts = {};
    bool port_failed() const
    {
        return in_.stalled || out_.stalled;
    }

private:
    void frame();
    void step();
    void schedule(uint64_t cycle);
    Packet in_token(const Pipe &pipe) const;
    bool choose();
    void transfer();
    void finish();
    void finish_pipe(Pipe &pipe);
    bool take_in(Pipe &pipe, std::deque<uint8_t> &sink);

    bool plugged_ = false, frames_on_ = false, resetting_ = false;
    bool waiting_ = false, done_ = false, busy_ = false;
    unsigned frame_number_ = 0, address_ = 0, generation_ = 0;
    uint64_t frame_start_ = 0, idle_since_ = 0;
    bool idle_told_ = false;
    enum class Owner { Test, In, Out, Notify } owner_ = Owner::Test;
    Pipe in_, out_, notify_;
    Packet current_;
    Handshake answer_ = Handshake::None;
    bool last_was_in_ = false;
    bool unacknowledged_ = false; // an ACK of ours got lost on the bus
};

UsbHost &usb_host();

} // namespace lathe

#endif
