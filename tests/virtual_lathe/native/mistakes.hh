// SPDX-License-Identifier: Apache-2.0
// A list of what the firmware does although a data sheet forbids it, each
// with the cycle and the address of the instruction after.

#ifndef VIRTUAL_LATHE_MISTAKES_HH
#define VIRTUAL_LATHE_MISTAKES_HH

#include <cstdarg>
#include <cstdio>

#include "chip.hh"

namespace lathe
{

// printf into a string.
__attribute__((format(printf, 1, 2))) inline std::string
text(const char *format, ...)
{
    char line[200];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    return line;
}

class Mistakes
{
public:
    void add(const std::string &what)
    {
        if (list_.size() < MOST)
            list_.push_back(text("cycle %llu, address 0x%04x: ",
                                 (unsigned long long)chip().now(),
                                 chip().cpu->pc->value * 2) +
                            what);
    }
    // Copies the text of one; -1 when there are fewer.
    int copy(unsigned index, char *line, unsigned room) const
    {
        if (index >= list_.size())
            return -1;
        snprintf(line, room, "%s", list_[index].c_str());
        return 0;
    }

private:
    static constexpr size_t MOST = 200;
    std::vector<std::string> list_;
};

} // namespace lathe

#endif
