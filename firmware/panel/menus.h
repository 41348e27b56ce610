/* SPDX-License-Identifier: Apache-2.0
 *
 * Numbers of the panel's menus and texts.
 * Generated from menus.toml by generate_menus.py: do not edit.
 */
#ifndef MENUS_H
#define MENUS_H

/* What an entry does, and the bit of a menu's last one. */
#define KIND_HOME                0
#define KIND_MOVE                1
#define KIND_ZERO                2
#define KIND_TOUCH               3
#define KIND_GO_ZERO             4
#define KIND_RUN                 5
#define KIND_PART                6
#define KIND_MENU                7
#define KIND_SETTING             8
#define KIND_DIAMETER            9
#define KIND_CHOICE              10
#define KIND_DEAD                11
#define KIND_LANGUAGE            12
#define MENU_LAST                0x80

/* First text of each group. */
#define TEXT_ENTRY               0
#define TEXT_STATE               25
#define TEXT_ALARM               33
#define TEXT_WAY                 49
#define TEXT_ERROR               55
#define TEXT_NOT_HOMED           75
#define TEXT_CONTINUOUS          76
#define TEXT_RAPID               77
#define TEXT_LANGUAGE            78
#define TEXT_NO_CONTACT          79
#define TEXT_ZERO_SET            80
#define TEXT_FINISHED            81

/* MENU_ENTRIES(X): X(kind, with) for each entry, its text is its number. */
#define MENU_ENTRIES(X)                                                      \
    X(KIND_HOME, 0)                                                          \
    X(KIND_PART, 0)                                                          \
    X(KIND_MENU, 10)                                                         \
    X(KIND_RUN, 0)                                                           \
    X(KIND_RUN, 1)                                                           \
    X(KIND_RUN, 2)                                                           \
    X(KIND_MENU, 15)                                                         \
    X(KIND_GO_ZERO, 0)                                                       \
    X(KIND_DEAD, 0)                                                          \
    X(KIND_MENU | MENU_LAST, 18)                                             \
    X(KIND_DIAMETER, 0)                                                      \
    X(KIND_ZERO, 0)                                                          \
    X(KIND_ZERO, 1)                                                          \
    X(KIND_TOUCH, 0)                                                         \
    X(KIND_TOUCH | MENU_LAST, 1)                                             \
    X(KIND_MOVE, 0)                                                          \
    X(KIND_CHOICE, 0)                                                        \
    X(KIND_CHOICE | MENU_LAST, 1)                                            \
    X(KIND_LANGUAGE, 0)                                                      \
    X(KIND_SETTING, SETTING_PANEL_INCH)                                      \
    X(KIND_SETTING, SETTING_RAPID_RATE_X)                                    \
    X(KIND_SETTING, SETTING_RAPID_RATE_Z)                                    \
    X(KIND_SETTING, SETTING_ACCELERATION)                                    \
    X(KIND_SETTING, SETTING_IDLE_MS)                                         \
    X(KIND_SETTING | MENU_LAST, SETTING_PROBE_FITTED)

/* ALARM_WAYS(X): X(way) for each alarm by number, from TEXT_WAY; with a bit
 * where it concerns an axis. */
#define WAY_AXIS                 0x80
#define ALARM_WAYS(X)                                                        \
    X(0)                                                                     \
    X(3 | WAY_AXIS)                                                          \
    X(3 | WAY_AXIS)                                                          \
    X(1 | WAY_AXIS)                                                          \
    X(2)                                                                     \
    X(0)                                                                     \
    X(3)                                                                     \
    X(5)                                                                     \
    X(0 | WAY_AXIS)                                                          \
    X(4 | WAY_AXIS)                                                          \
    X(0)                                                                     \
    X(0)                                                                     \
    X(4 | WAY_AXIS)                                                          \
    X(0 | WAY_AXIS)                                                          \
    X(3 | WAY_AXIS)                                                          \
    X(1)

#endif
