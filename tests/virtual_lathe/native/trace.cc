// SPDX-License-Identifier: Apache-2.0
// Value change dump of the pins, one wire per pin, as GTKWave reads it.

#include "pins.hh"

#include <cstdio>

namespace
{

FILE *dump;
bool listening;
uint64_t last_ns;

// 12 MHz: a cycle is 250/3 ns.
uint64_t nanoseconds(uint64_t cycle)
{
    return cycle * 250 / 3;
}

char code(int pin)
{
    return char('!' + pin);
}

void write_changes(uint64_t cycle, uint64_t levels, uint64_t changed)
{
    if (!dump)
        return;
    uint64_t ns = nanoseconds(cycle);
    if (ns != last_ns)
        fprintf(dump, "#%llu\n", (unsigned long long)ns);
    last_ns = ns;
    for (int pin = 0; pin < lathe::PIN_COUNT; pin++) {
        if (changed >> pin & 1 && lathe::pins().exists(pin))
            fprintf(dump, "%c%c\n", levels >> pin & 1 ? '1' : '0', code(pin));
    }
}

} // namespace

int vl_vcd_open(const char *path)
{
    vl_vcd_close();
    dump = fopen(path, "w");
    if (!dump)
        return -1;
    fprintf(dump, "$timescale 1 ns $end\n$scope module PIC18F4550 $end\n");
    for (int pin = 0; pin < lathe::PIN_COUNT; pin++) {
        if (lathe::pins().exists(pin))
            fprintf(dump, "$var wire 1 %c R%c%d $end\n", code(pin),
                    'A' + pin / 8, pin % 8);
    }
    fprintf(dump, "$upscope $end\n$enddefinitions $end\n#%llu\n$dumpvars\n",
            (unsigned long long)nanoseconds(lathe::chip().now()));
    last_ns = nanoseconds(lathe::chip().now());
    write_changes(lathe::chip().now(), lathe::pins().levels(), ~uint64_t{0});
    fprintf(dump, "$end\n");
    if (!listening)
        lathe::pins().listen(write_changes);
    listening = true;
    return 0;
}

void vl_vcd_close(void)
{
    if (!dump)
        return;
    fprintf(dump, "#%llu\n",
            (unsigned long long)nanoseconds(lathe::chip().now()));
    fclose(dump);
    dump = nullptr;
}
