// SPDX-License-Identifier: Apache-2.0
// Resets and the watchdog, by tables 4-1 to 4-4 and chapter 25 of the data
// sheet.  gpsim leaves most registers alone at other resets than power-on and
// counts its watchdog in another clock, so both are done here.

#include "chip.hh"
#include "gpsim_versions.hh"
#include "virtual_lathe.h"

namespace lathe
{

namespace
{

constexpr unsigned WDTCON_ADDRESS = 0xFD1;
constexpr unsigned CONFIG2 = 0x300002;
// Watchdog period without postscaler: typical of the data sheet.
constexpr uint64_t WATCHDOG_CYCLES = 4 * CYCLES_PER_MS;

enum : uint8_t { BOR = 1, POR = 2, PD = 4, TO = 8, RI = 16, SBOREN = 64 };
enum : uint8_t { STKUNF = 0x40, STKFUL = 0x80 };

uint8_t rcon_after(RESET_TYPE type, uint8_t before)
{
    before &= BOR | POR | PD | TO | RI | SBOREN;
    switch (type) {
    case POR_RESET:
        return SBOREN | RI | TO | PD;
    case BOD_RESET:
        return ((before | RI | TO | PD) & ~BOR);
    case WDT_RESET:
        return before & ~TO;
    case SOFT_RESET:
        return before & ~RI;
    default:
        return before;
    }
}

uint8_t stkptr_after(RESET_TYPE type, uint8_t before)
{
    switch (type) {
    case POR_RESET:
    case BOD_RESET:
        return 0;
    case STKOVF_RESET:
        return (before & STKUNF) | STKFUL;
    case STKUNF_RESET:
        return (before & STKFUL) | STKUNF;
    default:
        return before & (STKFUL | STKUNF);
    }
}

} // namespace

void Chip::note_reset(RESET_TYPE type)
{
    if (resetting_ || type == EXIT_RESET)
        return;
    resets.emplace_back(now(), static_cast<int>(type));
    rcon_next_ = rcon_after(type, cpu->rcon.value.get());
    stkptr_next_ = stkptr_after(type, cpu->registers[STKPTR]->get_value());
    reset_seen_ = true;
    wake();
}

// Runs at the instruction boundary after a reset of any kind.
void Chip::finish_reset()
{
    reset_seen_ = false;
    resetting_ = true;
    std::vector<RegisterValue> ram;
    for (unsigned i = 0; i < RAM_BYTES; i++)
        ram.push_back(cpu->registers[i]->value);
    cpu->reset(POR_RESET);
    // RAM survives everything but the loss of power (table 4-4).
    for (unsigned i = 0; i < RAM_BYTES && resets.back().second != POR_RESET;
         i++)
        cpu->registers[i]->value = ram[i];
    resetting_ = false;
    cpu->rcon.value.put(rcon_next_);
    cpu->registers[STKPTR]->put_value(stkptr_next_);
    allow_nesting(cpu->intcon, 0);
    cpu->mCurrentPhase = cpu->mExecute1Cycle;
    cpu->mExecute1Cycle->setNextPhase(cpu->mExecute1Cycle);
    nesting_.clear();
    stalled_until_ = 0;
    feed_watchdog();
    for (const auto &hook : on_reset_)
        hook(static_cast<RESET_TYPE>(resets.back().second));
}

void Chip::reset(RESET_TYPE type)
{
    note_reset(type);
    attend();
}

void Chip::start_watchdog()
{
    switch_off(cpu->wdt);
    unsigned config = cpu->get_config_word(CONFIG2) >> 8;
    watchdog_always_ = config & 1;
    watchdog_period_ = WATCHDOG_CYCLES << (config >> 1 & 0xF);
    feed_watchdog();
    watch();
}

void Chip::feed_watchdog()
{
    watchdog_deadline_ = now() + watchdog_period_;
}

void Chip::watch()
{
    bool on =
        watchdog_always_ || (cpu->registers[WDTCON_ADDRESS]->get_value() & 1);
    if (!on)
        feed_watchdog();
    if (now() >= watchdog_deadline_)
        reset(WDT_RESET);
    uint64_t next = on ? watchdog_deadline_ : now() + CYCLES_PER_MS;
    at(next, [this] { watch(); });
}

} // namespace lathe
