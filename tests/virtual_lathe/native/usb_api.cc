// SPDX-License-Identifier: Apache-2.0
// The C functions for the USB engine and the host.

#include "usb_host.hh"
#include "virtual_lathe.h"

#include <algorithm>
#include <cstdio>

using lathe::usb_engine;
using lathe::usb_host;

void vl_usb_attach(void)
{
    usb_host().attach();
}

void vl_usb_plug(int in)
{
    usb_host().plug(in);
}
int vl_usb_connected(void)
{
    return usb_host().plugged() && usb_engine().connected();
}
void vl_usb_reset(int active)
{
    usb_host().drive_reset(active);
}
void vl_usb_suspend(int on)
{
    usb_host().suspend(on);
}

void vl_usb_submit(int token, unsigned address, unsigned endpoint,
                   unsigned toggle, const uint8_t *data, unsigned count,
                   int fresh)
{
    usb_host().submit({static_cast<lathe::Token>(token),
                       address,
                       endpoint,
                       toggle,
                       {data, data + count},
                       fresh != 0});
}

int vl_usb_result(uint8_t data[64], unsigned *count, unsigned *toggle)
{
    if (!usb_host().done())
        return -1;
    const lathe::Packet &packet = usb_host().packet;
    *count = std::min<size_t>(64, packet.data.size());
    *toggle = packet.toggle;
    std::copy_n(packet.data.begin(), *count, data);
    return static_cast<int>(usb_host().result);
}

void vl_usb_open(unsigned address, unsigned in, unsigned out, unsigned notify)
{
    usb_host().open(address, in, out, notify);
}

void vl_usb_close(void)
{
    usb_host().close();
}

unsigned vl_usb_write(const uint8_t *data, unsigned count)
{
    constexpr size_t QUEUE_MAX = 4096;
    size_t room = QUEUE_MAX - std::min(QUEUE_MAX, usb_host().to_device.size());
    unsigned taken = std::min<size_t>(room, count);
    usb_host().to_device.insert(usb_host().to_device.end(), data, data + taken);
    return taken;
}

unsigned vl_usb_unsent(void)
{
    return usb_host().to_device.size();
}

unsigned vl_usb_read(uint8_t *data, unsigned room)
{
    auto &queue = usb_host().from_device;
    unsigned count = std::min<size_t>(room, queue.size());
    std::copy_n(queue.begin(), count, data);
    queue.erase(queue.begin(), queue.begin() + count);
    return count;
}

int vl_usb_port_failed(void)
{
    return usb_host().port_failed();
}
void vl_usb_lose_handshakes(unsigned n)
{
    usb_host().lose_handshakes = n;
}

void vl_usb_counts(struct vl_usb_counts *counts)
{
    const auto &c = usb_host().counts;
    *counts = {c.frames,   c.transactions, c.naks,      c.stalls,
               c.timeouts, c.bytes_in,     c.bytes_out, c.wrong_toggles};
}

int vl_usb_mistake(unsigned index, char *text, unsigned room)
{
    return usb_engine().mistakes.copy(index, text, room);
}

void vl_usb_report_mistake(const char *text)
{
    usb_engine().mistake(text);
}
