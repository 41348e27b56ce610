// SPDX-License-Identifier: Apache-2.0
// EECON1 and EECON2 of the PIC18F4550 (data sheet chapters 6 and 7).  gpsim's
// own model has latches of the wrong size and no real times, so these
// registers are ours; gpsim only keeps the program words.

#include "nonvolatile.hh"

#include <algorithm>
#include <cstring>

namespace lathe
{

namespace
{

enum : uint8_t {
    RD = 0x01,
    WR = 0x02,
    WREN = 0x04,
    WRERR = 0x08,
    FREE = 0x10,
    CFGS = 0x40,
    EEPGD = 0x80
};
constexpr unsigned EECON1_ADDRESS = 0xFA6, EECON2_ADDRESS = 0xFA7;
constexpr unsigned EEDATA_ADDRESS = 0xFA8, EEADR_ADDRESS = 0xFA9;
constexpr unsigned TBLPTRL_ADDRESS = 0xFF6;
// CONFIG6L: bits 0..3 = 0, blocks of 8 KB are protected; CONFIG6H: bit 6, the
// boot block, which block 0 then does not count.
constexpr unsigned BOOT_BYTES = 0x800, PROTECTED_BLOCK_BYTES = 0x2000;
constexpr unsigned NO_WRTB = 0x4000;
constexpr uint8_t EEIF = 0x10;
constexpr unsigned ERASE_BYTES = 64, WRITE_BYTES = 32;
// Typical times of the data sheet: parameters D122 (TDEW) and D133A (TIW).
constexpr uint64_t EEPROM_CYCLES = 4 * CYCLES_PER_MS;
constexpr uint64_t FLASH_CYCLES = 2 * CYCLES_PER_MS;
// movlw, movwf between the writes of 0x55 and 0xAA and of 0xAA and WR: the
// sequence must not be interrupted.
constexpr uint64_t UNLOCK_GAP_CYCLES = 2;

class Eecon1 : public sfr_register
{
public:
    explicit Eecon1(Module *m) : sfr_register(m, "eecon1_model", "")
    {
    }
    unsigned get() override
    {
        return nonvolatile().control();
    }
    unsigned get_value() override
    {
        return nonvolatile().control();
    }
    void put(unsigned v) override
    {
        nonvolatile().set_control(v);
    }
    void put_value(unsigned v) override
    {
        nonvolatile().set_control(v);
    }
    void reset(RESET_TYPE) override
    {
    }
};

class Eecon2 : public sfr_register
{
public:
    explicit Eecon2(Module *m) : sfr_register(m, "eecon2_model", "")
    {
    }
    unsigned get() override
    {
        return 0;
    }
    unsigned get_value() override
    {
        return 0;
    }
    void put(unsigned v) override
    {
        nonvolatile().unlock(v);
    }
    void put_value(unsigned v) override
    {
        nonvolatile().unlock(v);
    }
    void reset(RESET_TYPE) override
    {
    }
};

class Plain : public sfr_register
{
public:
    Plain(Module *m, const char *name) : sfr_register(m, name, "")
    {
    }
    void reset(RESET_TYPE) override
    {
    }
};

void install(unsigned address, Register *reg)
{
    reg->address = address;
    chip().cpu->registers[address] = reg;
}

unsigned sfr(unsigned address)
{
    return chip().cpu->registers[address]->get_value();
}

unsigned table_pointer()
{
    return sfr(TBLPTRL_ADDRESS) | sfr(TBLPTRL_ADDRESS + 1) << 8 |
           sfr(TBLPTRL_ADDRESS + 2) << 16;
}

} // namespace

Nonvolatile &nonvolatile()
{
    static Nonvolatile instance;
    return instance;
}

void Nonvolatile::attach()
{
    _16bit_processor *cpu = chip().cpu;
    std::fill_n(latches_, WRITE_BYTES, 0xFF);
    for (unsigned i = 0; i < EEPROM_BYTES; i++)
        eeprom[i] = cpu->get_eeprom()->get_rom()[i]->get_value();
    // gpsim starts with zeros where the program says nothing; a chip fresh from
    // the programmer is erased.
    if (std::all_of(eeprom, eeprom + EEPROM_BYTES,
                    [](uint8_t byte) { return byte == 0; }))
        std::fill_n(eeprom, EEPROM_BYTES, 0xFF);
    for (unsigned word = 0; word < FLASH_BYTES / 2; word++) {
        // Never programmed; tables hold words that are no instruction either.
        if (cpu->program_memory[word] == &cpu->bad_instruction)
            cpu->pma->put_rom(word * 2, 0xFFFF);
    }
    install(EECON1_ADDRESS, new Eecon1(cpu));
    install(EECON2_ADDRESS, new Eecon2(cpu));
    install(EEDATA_ADDRESS, new Plain(cpu, "eedata_model"));
    install(EEADR_ADDRESS, new Plain(cpu, "eeadr_model"));
    chip().add_on_reset([this](RESET_TYPE) { power_lost(); });
}

uint8_t Nonvolatile::flash(unsigned address) const
{
    unsigned word = chip().cpu->pma->get_rom(address & (FLASH_BYTES - 2));
    return address & 1 ? word >> 8 : word;
}

void Nonvolatile::set_flash(unsigned address, uint8_t byte)
{
    unsigned even = address & (FLASH_BYTES - 2);
    unsigned word = chip().cpu->pma->get_rom(even);
    unsigned changed =
        address & 1 ? (word & 0x00FF) | byte << 8 : (word & 0xFF00) | byte;
    if (changed != word)
        chip().cpu->pma->put_rom(even, changed);
}

void Nonvolatile::latch(unsigned address, uint8_t byte)
{
    latches_[address % WRITE_BYTES] = byte;
}

void Nonvolatile::unlock(uint8_t value)
{
    bool prompt = chip().now() - unlock_at_ <= UNLOCK_GAP_CYCLES;
    unlocked_ = value == 0x55                               ? 1
                : value == 0xAA && unlocked_ == 1 && prompt ? 2
                                                            : 0;
    unlock_at_ = chip().now();
}

void Nonvolatile::set_control(uint8_t value)
{
    bool begin = value & WR && !(control_ & WR);
    bool read = value & RD;
    uint8_t running = control_ & WR;
    bool enabled = control_ & WREN && value & WREN;
    control_ = (value & ~(WR | RD)) | running;
    if (read && !running && !(value & (EEPGD | CFGS)))
        chip().cpu->registers[EEDATA_ADDRESS]->value.put(
            eeprom[sfr(EEADR_ADDRESS)]);
    if (!begin)
        return;
    bool prompt = chip().now() - unlock_at_ <= UNLOCK_GAP_CYCLES;
    if (unlocked_ == 2 && prompt && enabled && !(value & CFGS))
        start();
    else
        broken_unlocks++;
    unlocked_ = 0;
}

// Whether the flash at target_ is not write-protected (table 25-4).
bool Nonvolatile::writable() const
{
    if (target_ < BOOT_BYTES)
        return config6 & NO_WRTB;
    return config6 >> target_ / PROTECTED_BLOCK_BYTES & 1;
}

void Nonvolatile::start()
{
    control_ |= WR;
    began_ = chip().now();
    bool program = control_ & EEPGD;
    busy_until_ = began_ + (program ? FLASH_CYCLES : EEPROM_CYCLES);
    target_ = program ? table_pointer() % FLASH_BYTES : sfr(EEADR_ADDRESS);
    data_ = sfr(EEDATA_ADDRESS);
    uint64_t end = busy_until_;
    chip().at(end, [this, end] {
        if (busy_until_ == end)
            finish();
    });
    if (program)
        chip().stall(end);
}

void Nonvolatile::finish()
{
    busy_until_ = 0;
    control_ &= ~WR;
    if (!(control_ & EEPGD)) {
        eeprom[target_] = data_;
        eeprom_writes++;
        Register *flags = chip().cpu->registers[PIR2];
        flags->put(flags->get_value() | EEIF);
    } else if (control_ & FREE) {
        flash_erases++;
        control_ &= ~FREE;
        if (!writable())
            return;
        for (unsigned i = 0; i < ERASE_BYTES; i++)
            set_flash((target_ & ~(ERASE_BYTES - 1)) + i, 0xFF);
    } else {
        flash_writes++;
        unsigned block = target_ & ~(WRITE_BYTES - 1);
        for (unsigned i = 0; i < WRITE_BYTES && writable(); i++)
            set_flash(block + i, flash(block + i) & latches_[i]);
        std::fill_n(latches_, WRITE_BYTES, 0xFF);
    }
}

// An interrupted EEPROM write has erased its byte during the first half and
// is done in the second; of a flash block the part in proportion to the time
// has been treated.
void Nonvolatile::power_lost()
{
    if (busy_until_) {
        uint64_t done = chip().now() - began_;
        if (!(control_ & EEPGD)) {
            eeprom[target_] = done < EEPROM_CYCLES / 2 ? 0xFF : data_;
        } else if (!writable()) {
            // nothing has changed
        } else if (control_ & FREE) {
            unsigned block = target_ & ~(ERASE_BYTES - 1);
            for (unsigned i = 0; i < ERASE_BYTES * done / FLASH_CYCLES; i++)
                set_flash(block + i, 0xFF);
        } else {
            unsigned block = target_ & ~(WRITE_BYTES - 1);
            for (unsigned i = 0; i < WRITE_BYTES * done / FLASH_CYCLES; i++)
                set_flash(block + i, flash(block + i) & latches_[i]);
        }
        control_ |= WRERR;
    }
    busy_until_ = 0;
    unlocked_ = 0;
    control_ &= WRERR | EEPGD | CFGS;
    std::fill_n(latches_, WRITE_BYTES, 0xFF);
}

} // namespace lathe
