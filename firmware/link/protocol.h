/* SPDX-License-Identifier: Apache-2.0
 *
 * Numbers shared with the host: frames, commands, codes, part image, settings.
 * Generated from protocol.toml by generate_protocol.py: do not edit.
 */
#ifndef LINK_PROTOCOL_H
#define LINK_PROTOCOL_H

#define PROTOCOL_VERSION                    1
#define FIRMWARE_VERSION_MAJOR              0
#define FIRMWARE_VERSION_MINOR              1
#define FIRMWARE_VERSION_PATCH              0
#define USB_VENDOR_ID                       0x1209
#define USB_PRODUCT_ID                      0x0001

/* Frame: seq, code, payload, CRC low byte first, all in COBS, then 0x00. */
#define FRAME_PAYLOAD_MAX                   56
#define FRAME_BODY_MAX                      60
#define FRAME_ENCODED_MAX                   62
#define FRAME_SEQ_AT                        0
#define FRAME_CODE_AT                       1
#define FRAME_PAYLOAD_AT                    2
#define FRAME_RESPONSE_BIT                  0x80
#define CRC16_POLYNOMIAL                    0x1021
#define CRC16_INITIAL                       0xFFFF

/* parts the chip can store */
#define PART_SLOTS                          8
/* no slot; in RUN: the selected part */
#define SLOT_NONE                           255
/* bytes of a part image */
#define PART_IMAGE_MAX                      960
/* bytes of one UPLOAD_DATA or PART_READ piece */
#define UPLOAD_PIECE_MAX                    32
/* operations of one part */
#define OPERATIONS_MAX                      48
/* characters of a part name */
#define NAME_LENGTH                         16
/* characters of the serial number */
#define SERIAL_LENGTH                       8
/* steps, largest length or radius in a part image: the chip counts in 16
 * bits */
#define POSITION_MAX                        32000
/* 1/256 step/s, slowest feed: 4 step/s */
#define FEED_MIN                            1024
/* feed units of one step/s */
#define FEED_UNIT                           256
/* percent, slowest feed override */
#define OVERRIDE_MIN                        10
/* percent, fastest feed override */
#define OVERRIDE_MAX                        200
/* progress of a finished run */
#define PERMILLE_DONE                       1000

/* Axes, as in ZERO and in the detail of an alarm. */
#define AXIS_X                              0
#define AXIS_Z                              1

/* States in STATUS. */
#define STATE_IDLE                          0
#define STATE_HOMING                        1
#define STATE_RUNNING                       2
#define STATE_HOLD                          3
#define STATE_ALARM                         4

/* Bits of the flags in STATUS. */
#define STATUS_FLAG_HOMED                   0x01
#define STATUS_FLAG_SWITCH_X                0x02
#define STATUS_FLAG_SWITCH_Z                0x04
#define STATUS_FLAG_ESTOP                   0x08
#define STATUS_FLAG_BUTTON_RUN              0x10
#define STATUS_FLAG_BUTTON_HOLD             0x20
#define STATUS_FLAG_BUTTON_STOP             0x40
#define STATUS_FLAG_MOTION                  0x80

/* Alarms in STATUS. */
#define ALARM_NONE                          0
#define ALARM_HOME_NOT_FOUND                1
#define ALARM_HOME_NOT_RELEASED             2
#define ALARM_LIMIT                         3
#define ALARM_ESTOP                         4
#define ALARM_STREAM_DRY                    5
#define ALARM_WRONG_SWITCH                  6
#define ALARM_SETTINGS_LOST                 7
#define ALARM_STOPPED_HOMING                8
#define ALARM_DEAD_STEPS_SPREAD             9
#define ALARM_INTERNAL                      10
#define ALARM_PATH                          11

/* Why the chip last started. */
#define RESET_CAUSE_POWER_ON                1
#define RESET_CAUSE_BROWN_OUT               2
#define RESET_CAUSE_WATCHDOG                3
#define RESET_CAUSE_MCLR                    4
#define RESET_CAUSE_STACK                   5
#define RESET_CAUSE_SOFTWARE                6

/* First payload byte of every response. */
#define ERROR_OK                            0
#define ERROR_UNKNOWN_COMMAND               1
#define ERROR_BAD_LENGTH                    2
#define ERROR_BUSY                          3
#define ERROR_NOT_HOMED                     4
#define ERROR_ALARM                         5
#define ERROR_NO_PART                       6
#define ERROR_INVALID_PART                  7
#define ERROR_OUT_OF_RANGE                  8
#define ERROR_NOT_RUNNING                   9
#define ERROR_BAD_OFFSET                    10
#define ERROR_NO_UPLOAD                     11
#define ERROR_CRC_MISMATCH                  12
#define ERROR_STORE_FULL                    13
#define ERROR_FLASH_FAILED                  14
#define ERROR_ESTOP                         15

/* Commands. _REQUEST_SIZE: payload bytes; _RESPONSE_SIZE: payload bytes
 * with the error byte; an open payload has _MIN and _MAX. _AT: offset in
 * the payload. */
/* Who are you? Starts the sequence anew; always executed. */
#define COMMAND_HELLO                       0x01
#define HELLO_REQUEST_SIZE                  0
#define HELLO_RESPONSE_SIZE                 42
#define HELLO_RESPONSE_PROTOCOL_AT          1
#define HELLO_RESPONSE_FIRMWARE_MAJOR_AT    2
#define HELLO_RESPONSE_FIRMWARE_MINOR_AT    3
#define HELLO_RESPONSE_FIRMWARE_PATCH_AT    4
#define HELLO_RESPONSE_SLOTS_AT             5
#define HELLO_RESPONSE_IMAGE_MAX_AT         6
#define HELLO_RESPONSE_STEP_X_NM_AT         8
#define HELLO_RESPONSE_STEP_Z_NM_AT         12
#define HELLO_RESPONSE_TRAVEL_X_AT          16
#define HELLO_RESPONSE_TRAVEL_Z_AT          20
#define HELLO_RESPONSE_ZERO_X_AT            24
#define HELLO_RESPONSE_ZERO_Z_AT            28
#define HELLO_RESPONSE_SERIAL_AT            32
#define HELLO_RESPONSE_MAX_RATE_AT          40
/* Where is the tool, what is the machine doing? */
#define COMMAND_STATUS                      0x02
#define STATUS_REQUEST_SIZE                 0
#define STATUS_RESPONSE_SIZE                32
#define STATUS_RESPONSE_STATE_AT            1
#define STATUS_RESPONSE_ALARM_AT            2
#define STATUS_RESPONSE_ALARM_DETAIL_AT     3
#define STATUS_RESPONSE_FLAGS_AT            4
#define STATUS_RESPONSE_X_AT                5
#define STATUS_RESPONSE_Z_AT                9
#define STATUS_RESPONSE_DEAD_X_AT           13
#define STATUS_RESPONSE_DEAD_Z_AT           15
#define STATUS_RESPONSE_SLOT_AT             17
#define STATUS_RESPONSE_OPERATION_AT        18
#define STATUS_RESPONSE_OPERATIONS_AT       19
#define STATUS_RESPONSE_PASS_NUMBER_AT      20
#define STATUS_RESPONSE_PASSES_AT           21
#define STATUS_RESPONSE_PERMILLE_AT         22
#define STATUS_RESPONSE_RESET_CAUSE_AT      24
#define STATUS_RESPONSE_BAD_FRAMES_AT       25
#define STATUS_RESPONSE_UPTIME_MS_AT        27
#define STATUS_RESPONSE_STREAM_LOW_AT       31
/* Find the limit switches, X first, and measure the dead steps. Answered at
 * once; STATUS tells the end. */
#define COMMAND_HOME                        0x03
#define HOME_REQUEST_SIZE                   0
#define HOME_RESPONSE_SIZE                  1
/* Cut a part. Answered when the chip has checked the part again; STATUS
 * tells the rest. */
#define COMMAND_RUN                         0x04
#define RUN_REQUEST_SIZE                    1
#define RUN_RESPONSE_SIZE                   1
#define RUN_SLOT_AT                         0
/* Stop the run so that it can go on. OK too when it is already held. */
#define COMMAND_HOLD                        0x05
#define HOLD_REQUEST_SIZE                   0
#define HOLD_RESPONSE_SIZE                  1
/* Go on after HOLD. OK too when it already runs. */
#define COMMAND_RESUME                      0x06
#define RESUME_REQUEST_SIZE                 0
#define RESUME_RESPONSE_SIZE                1
/* End the run or the homing. The position stays trusted, except while
 * homing (alarm STOPPED_HOMING). */
#define COMMAND_STOP                        0x07
#define STOP_REQUEST_SIZE                   0
#define STOP_RESPONSE_SIZE                  1
/* Acknowledge an alarm. The machine is then IDLE. */
#define COMMAND_RESET                       0x08
#define RESET_REQUEST_SIZE                  0
#define RESET_RESPONSE_SIZE                 1
/* The tool now stands at this part coordinate; the part zero is stored. */
#define COMMAND_ZERO                        0x09
#define ZERO_REQUEST_SIZE                   5
#define ZERO_RESPONSE_SIZE                  1
#define ZERO_AXIS_AT                        0
#define ZERO_VALUE_AT                       1
/* Feed of the run, in percent of the programmed one; rapids keep theirs.
 * Every run starts with 100. */
#define COMMAND_OVERRIDE                    0x0A
#define OVERRIDE_REQUEST_SIZE               1
#define OVERRIDE_RESPONSE_SIZE              1
#define OVERRIDE_PERCENT_AT                 0
/* Start to receive a part image; an upload under way is forgotten.
 * OUT_OF_RANGE: length is not 56 to 960. */
#define COMMAND_UPLOAD_BEGIN                0x10
#define UPLOAD_BEGIN_REQUEST_SIZE           4
#define UPLOAD_BEGIN_RESPONSE_SIZE          1
#define UPLOAD_BEGIN_LENGTH_AT              0
#define UPLOAD_BEGIN_CRC_AT                 2
/* One piece of the image, in order. BAD_OFFSET: not the next piece, or not
 * 32 bytes and not the last. */
#define COMMAND_UPLOAD_DATA                 0x11
#define UPLOAD_DATA_REQUEST_MIN             3
#define UPLOAD_DATA_REQUEST_MAX             34
#define UPLOAD_DATA_RESPONSE_SIZE           1
#define UPLOAD_DATA_OFFSET_AT               0
#define UPLOAD_DATA_DATA_AT                 2
/* Check the whole image and make it a part, which is then selected.
 * INVALID_PART is followed by reason u8 and operation u8. BAD_LENGTH:
 * pieces are missing. */
#define COMMAND_UPLOAD_COMMIT               0x12
#define UPLOAD_COMMIT_REQUEST_SIZE          0
#define UPLOAD_COMMIT_RESPONSE_SIZE         4
#define UPLOAD_COMMIT_RESPONSE_SLOT_AT      1
#define UPLOAD_COMMIT_RESPONSE_CRC_AT       2
/* What is in a slot? */
#define COMMAND_PART_INFO                   0x13
#define PART_INFO_REQUEST_SIZE              1
#define PART_INFO_RESPONSE_SIZE             26
#define PART_INFO_SLOT_AT                   0
#define PART_INFO_RESPONSE_PRESENT_AT       1
#define PART_INFO_RESPONSE_SELECTED_AT      2
#define PART_INFO_RESPONSE_GENERATION_AT    3
#define PART_INFO_RESPONSE_LENGTH_AT        5
#define PART_INFO_RESPONSE_CRC_AT           7
#define PART_INFO_RESPONSE_OPERATIONS_AT    9
#define PART_INFO_RESPONSE_NAME_AT          10
/* Read a stored image. BAD_OFFSET: behind the end, or no multiple of 32. */
#define COMMAND_PART_READ                   0x14
#define PART_READ_REQUEST_SIZE              3
#define PART_READ_RESPONSE_MIN              2
#define PART_READ_RESPONSE_MAX              33
#define PART_READ_SLOT_AT                   0
#define PART_READ_OFFSET_AT                 1
#define PART_READ_RESPONSE_DATA_AT          1
/* Choose the part that the RUN button cuts. */
#define COMMAND_PART_SELECT                 0x15
#define PART_SELECT_REQUEST_SIZE            1
#define PART_SELECT_RESPONSE_SIZE           1
#define PART_SELECT_SLOT_AT                 0
/* Empty a slot. */
#define COMMAND_PART_DELETE                 0x16
#define PART_DELETE_REQUEST_SIZE            1
#define PART_DELETE_RESPONSE_SIZE           1
#define PART_DELETE_SLOT_AT                 0
/* Read a setting and its range. */
#define COMMAND_SETTING_GET                 0x20
#define SETTING_GET_REQUEST_SIZE            1
#define SETTING_GET_RESPONSE_SIZE           13
#define SETTING_GET_ID_AT                   0
#define SETTING_GET_RESPONSE_VALUE_AT       1
#define SETTING_GET_RESPONSE_MINIMUM_AT     5
#define SETTING_GET_RESPONSE_MAXIMUM_AT     9
/* Change a setting; stored in EEPROM before the answer. */
#define COMMAND_SETTING_SET                 0x21
#define SETTING_SET_REQUEST_SIZE            5
#define SETTING_SET_RESPONSE_SIZE           1
#define SETTING_SET_ID_AT                   0
#define SETTING_SET_VALUE_AT                1
/* Give the chip another serial number, stored in EEPROM before the answer.
 * HELLO shows it at once, USB from the next connection on. */
#define COMMAND_SERIAL_SET                  0x22
#define SERIAL_SET_REQUEST_SIZE             8
#define SERIAL_SET_RESPONSE_SIZE            1
#define SERIAL_SET_SERIAL_AT                0

/* Part image: header, then one record per operation. */
#define PART_IMAGE_FORMAT                   1
#define PART_IMAGE_HEADER_SIZE              56
#define PART_IMAGE_FORMAT_AT                0
#define PART_IMAGE_OPERATION_COUNT_AT       1
#define PART_IMAGE_FLAGS_AT                 2
#define PART_IMAGE_RESERVED_AT              3
#define PART_IMAGE_NAME_AT                  4
#define PART_IMAGE_STEP_X_NM_AT             20
#define PART_IMAGE_STEP_Z_NM_AT             24
#define PART_IMAGE_STOCK_RADIUS_AT          28
#define PART_IMAGE_STOCK_LENGTH_AT          32
#define PART_IMAGE_STOCK_FRONT_AT           36
#define PART_IMAGE_DEPTH_OF_CUT_AT          40
#define PART_IMAGE_FINISH_ALLOWANCE_AT      42
#define PART_IMAGE_FEED_AT                  44
#define PART_IMAGE_FINISH_FEED_AT           48
#define PART_IMAGE_RETRACT_AT               52
#define PART_IMAGE_RESERVED_END_AT          54

/* Every operation record starts with these four bytes. */
#define OPERATION_TYPE_AT                   0
#define OPERATION_SIZE_AT                   1
#define OPERATION_FLAGS_AT                  2
#define OPERATION_RESERVED_AT               3

/* Cut everything in front of z, from outside to x_inner. */
#define OPERATION_FACE                      1
#define OPERATION_FACE_SIZE                 12
#define OPERATION_FACE_Z_AT                 4
#define OPERATION_FACE_X_INNER_AT           8

/* Cut everything between z_start and z_end that is larger than x. */
#define OPERATION_CYLINDER                  2
#define OPERATION_CYLINDER_SIZE             16
#define OPERATION_CYLINDER_Z_START_AT       4
#define OPERATION_CYLINDER_Z_END_AT         8
#define OPERATION_CYLINDER_X_AT             12

/* Why a part is refused. The first broken rule is answered. First for the
 * whole part (operation 0): LENGTH, FORMAT, NAME, STEP_SIZE, STOCK,
 * OPERATION_COUNT, DEPTH_OF_CUT, ALLOWANCE, FEED, RETRACT, OUTSIDE_TRAVEL.
 * Then for each operation in turn: LENGTH, OPERATION_TYPE, OPERATION_SIZE,
 * FORMAT, OUTSIDE_STOCK, OUTSIDE_TRAVEL, EMPTY_CUT, BLOCKED. After the last
 * one (operation 0): LENGTH. */
/* format is not 1, or a byte or flag that must be 0 is not */
#define REFUSAL_FORMAT                      1
/* shorter than its header, longer than 960 bytes, fewer than 12 bytes left
 * for a record, a record that reaches behind the end, or bytes left after
 * the last record */
#define REFUSAL_LENGTH                      2
/* empty, a character other than a-z 0-9 -, or characters after the first
 * zero */
#define REFUSAL_NAME                        3
/* step_x_nm or step_z_nm differs from the setting */
#define REFUSAL_STEP_SIZE                   4
/* stock_radius or stock_length is not 1 to 32000, or stock_front is not 0
 * to 32000 */
#define REFUSAL_STOCK                       5
/* depth_of_cut is 0 or more than stock_radius */
#define REFUSAL_DEPTH_OF_CUT                6
/* feed or finish_feed is below 1024 or above 256 * max_rate */
#define REFUSAL_FEED                        7
/* retract is 0 */
#define REFUSAL_RETRACT                     8
/* operation_count is not 1 to 48 */
#define REFUSAL_OPERATION_COUNT             9
/* unknown type */
#define REFUSAL_OPERATION_TYPE              10
/* size is not that of its type */
#define REFUSAL_OPERATION_SIZE              11
/* x below 0 or above stock_radius, z_start above stock_front, or z or z_end
 * below retract - stock_length */
#define REFUSAL_OUTSIDE_STOCK               12
/* whole part: zero_x + stock_radius + retract above 0, or zero_z +
 * stock_front + retract above 0; operation: zero_x + x below -travel_x, or
 * zero_z + z (z_end) below -travel_z */
#define REFUSAL_OUTSIDE_TRAVEL              13
/* cylinder: z_start not above z_end, or x equal to stock_radius; face: z
 * not below stock_front, or x_inner equal to stock_radius */
#define REFUSAL_EMPTY_CUT                   14
/* cylinder: z_start is below stock_front and no earlier operation with
 * z_end (z) at or below this z_start has an x at or below this x */
#define REFUSAL_BLOCKED                     15
/* finish_allowance is more than depth_of_cut */
#define REFUSAL_ALLOWANCE                   16

/* Settings by id. */
#define SETTING_STEP_X_NM                   0
#define SETTING_STEP_Z_NM                   1
#define SETTING_TRAVEL_X                    2
#define SETTING_TRAVEL_Z                    3
#define SETTING_ZERO_X                      4
#define SETTING_ZERO_Z                      5
#define SETTING_HOME_RATE                   6
#define SETTING_LATCH_RATE                  7
#define SETTING_RAPID_RATE_X                8
#define SETTING_RAPID_RATE_Z                9
#define SETTING_SWITCH_TRAVEL_X             10
#define SETTING_SWITCH_TRAVEL_Z             11
#define SETTING_COIL_MODE                   12
#define SETTING_ESTOP_FITTED                13
#define SETTING_INVERT_X                    14
#define SETTING_INVERT_Z                    15
#define SETTING_DEAD_MAX                    16
#define SETTING_DEAD_X                      17
#define SETTING_DEAD_Z                      18
#define SETTING_HOMING_REPEATS              19
#define SETTING_SPREAD_MAX                  20
#define SETTING_ACCELERATION                21
#define SETTING_START_RATE_X                22
#define SETTING_START_RATE_Z                23
#define SETTING_IDLE_MS                     24
#define SETTING_PULSE_US                    25
#define SETTING_COUNT                       26

/* SETTINGS(X): X(id, name, default, min, max) for each, in order of id. */
#define SETTINGS(X)                                                          \
    X(0, STEP_X_NM, 7112, 100, 32000)                                        \
    X(1, STEP_Z_NM, 7112, 100, 32000)                                        \
    X(2, TRAVEL_X, 3575, 100, 32000)                                         \
    X(3, TRAVEL_Z, 16072, 100, 32000)                                        \
    X(4, ZERO_X, (-3575), (-32000), 0)                                       \
    X(5, ZERO_Z, (-8000), (-32000), 0)                                       \
    X(6, HOME_RATE, 800, 20, 4000)                                           \
    X(7, LATCH_RATE, 100, 20, 100)                                           \
    X(8, RAPID_RATE_X, 1000, 20, 32000)                                      \
    X(9, RAPID_RATE_Z, 1000, 20, 32000)                                      \
    X(10, SWITCH_TRAVEL_X, 0, 0, 200)                                        \
    X(11, SWITCH_TRAVEL_Z, 0, 0, 200)                                        \
    X(12, COIL_MODE, 0, 0, 3)                                                \
    X(13, ESTOP_FITTED, 1, 0, 1)                                             \
    X(14, INVERT_X, 0, 0, 1)                                                 \
    X(15, INVERT_Z, 0, 0, 1)                                                 \
    X(16, DEAD_MAX, 300, 0, 1000)                                            \
    X(17, DEAD_X, 0, 0, 1000)                                                \
    X(18, DEAD_Z, 0, 0, 1000)                                                \
    X(19, HOMING_REPEATS, 3, 1, 9)                                           \
    X(20, SPREAD_MAX, 2, 0, 50)                                              \
    X(21, ACCELERATION, 8000, 1100, 32000)                                   \
    X(22, START_RATE_X, 400, 20, 4000)                                       \
    X(23, START_RATE_Z, 400, 20, 4000)                                       \
    X(24, IDLE_MS, (-1), (-1), 32000)                                        \
    X(25, PULSE_US, 5, 5, 60)

#endif
