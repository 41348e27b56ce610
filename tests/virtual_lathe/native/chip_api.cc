// SPDX-License-Identifier: Apache-2.0
// The C functions for the chip alone: memory, resets, instruments.

#include "adc.hh"
#include "chip.hh"
#include "nonvolatile.hh"
#include "pins.hh"
#include "virtual_lathe.h"

#include <algorithm>
#include <iterator>
#include <random>

using lathe::chip;
using lathe::nonvolatile;

namespace
{

// A register that writes down who wrote to it and lets the write through.
class Watched : public Register
{
public:
    Watched(Module *owner, Register *inner, unsigned where)
        : Register(owner, inner->name().c_str()), inner_(inner)
    {
        address = where;
    }
    unsigned get() override
    {
        return inner_->get();
    }
    unsigned get_value() override
    {
        return inner_->get_value();
    }
    void put(unsigned value) override;
    void put_value(unsigned value) override
    {
        inner_->put_value(value);
    }
    void reset(RESET_TYPE type) override
    {
        inner_->reset(type);
    }
    REGISTER_TYPES isa() override
    {
        return inner_->isa();
    }

private:
    Register *inner_;
};

constexpr size_t WRITE_LOG_MAX = 65536;
std::vector<vl_ram_write> write_log;
uint8_t written[0x1000];

void Watched::put(unsigned value)
{
    written[address] = 1;
    if (write_log.size() < WRITE_LOG_MAX)
        write_log.push_back(
            {chip().now(), address, value, chip().cpu->pc->value * 2});
    inner_->put(value);
}

int reset_kind(int type)
{
    switch (type) {
    case POR_RESET:
        return VL_RESET_POWER_ON;
    case BOD_RESET:
        return VL_RESET_BROWN_OUT;
    case WDT_RESET:
        return VL_RESET_WATCHDOG;
    case MCLR_RESET:
        return VL_RESET_MCLR;
    case STKOVF_RESET:
        return VL_RESET_STACK_FULL;
    case STKUNF_RESET:
        return VL_RESET_STACK_EMPTY;
    case SOFT_RESET:
        return VL_RESET_SOFTWARE;
    default:
        return VL_RESET_OTHER;
    }
}

} // namespace

int vl_load(const char *path)
{
    if (chip().cpu || !chip().load(path))
        return -1;
    lathe::pins().attach();
    lathe::adc().attach();
    return 0;
}

int vl_run(uint64_t until)
{
    return chip().run(until);
}
uint64_t vl_cycle(void)
{
    return chip().now();
}
unsigned vl_program_counter(void)
{
    return chip().cpu->pc->value * 2;
}

unsigned vl_peek(unsigned address)
{
    return chip().cpu->registers[address & 0xFFF]->get_value();
}

void vl_poke(unsigned address, unsigned value)
{
    chip().cpu->registers[address & 0xFFF]->put_value(value & 0xFF);
}

unsigned vl_read(unsigned address)
{
    return chip().cpu->registers[address & 0xFFF]->get();
}

void vl_write(unsigned address, unsigned value)
{
    chip().cpu->registers[address & 0xFFF]->put(value & 0xFF);
}

void vl_set_break(unsigned address, int enabled)
{
    chip().set_break(address, enabled);
}

int vl_reset_chip(int kind)
{
    static const RESET_TYPE types[] = {POR_RESET, BOD_RESET, WDT_RESET,
                                       MCLR_RESET};
    if (kind < VL_RESET_POWER_ON || kind > VL_RESET_MCLR)
        return -1;
    chip().reset(types[kind]);
    return 0;
}

void vl_fill_ram(unsigned seed)
{
    std::mt19937 noise(seed);
    for (unsigned address = 0; address < lathe::RAM_BYTES; address++)
        chip().cpu->registers[address]->put_value(noise() & 0xFF);
}

int vl_resets(uint64_t *cycles, int *kinds, int room)
{
    const auto &resets = chip().resets;
    for (int i = 0; i < room && i < int(resets.size()); i++) {
        cycles[i] = resets[i].first;
        kinds[i] = reset_kind(resets[i].second);
    }
    return int(resets.size());
}

void vl_flash_read(unsigned address, uint8_t *bytes, unsigned count)
{
    for (unsigned i = 0; i < count; i++)
        bytes[i] = nonvolatile().flash(address + i);
}

void vl_flash_write(unsigned address, const uint8_t *bytes, unsigned count)
{
    for (unsigned i = 0; i < count; i++)
        nonvolatile().set_flash(address + i, bytes[i]);
    chip().classify();
}

void vl_eeprom_read(uint8_t bytes[256])
{
    std::copy_n(nonvolatile().eeprom, lathe::EEPROM_BYTES, bytes);
}

void vl_eeprom_write(const uint8_t bytes[256])
{
    std::copy_n(bytes, lathe::EEPROM_BYTES, nonvolatile().eeprom);
}

void vl_write_protection(unsigned config6)
{
    nonvolatile().config6 = config6;
}

void vl_nonvolatile_counts(struct vl_nonvolatile_counts *counts)
{
    *counts = {nonvolatile().eeprom_writes, nonvolatile().flash_erases,
               nonvolatile().flash_writes, nonvolatile().broken_unlocks};
}

void vl_interrupts(int priority, struct vl_interrupt_cost *cost)
{
    const lathe::InterruptCost &from = chip().interrupts[priority ? 1 : 0];
    *cost = {from.entries, from.total, from.entries ? from.best : 0, from.worst,
             from.worst_at};
}

unsigned vl_stack_depth_max(void)
{
    return chip().stack_depth_max;
}
void vl_clear_statistics(void)
{
    chip().clear_statistics();
}

void vl_executed(uint8_t flags[16384])
{
    std::copy(chip().executed.begin(), chip().executed.end(), flags);
}

int vl_watch_writes(unsigned first, unsigned last)
{
    if (last > 0xFFF || first > last)
        return -1;
    Register **registers = chip().cpu->registers;
    for (unsigned address = first; address <= last; address++)
        registers[address] =
            new Watched(chip().cpu, registers[address], address);
    return 0;
}

int vl_ram_writes(struct vl_ram_write *entries, int room)
{
    int count = std::min(room, int(write_log.size()));
    std::copy_n(write_log.begin(), count, entries);
    return int(write_log.size());
}

void vl_written(uint8_t flags[0x1000])
{
    std::copy(std::begin(written), std::end(written), flags);
}
