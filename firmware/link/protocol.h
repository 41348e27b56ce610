/* SPDX-License-Identifier: Apache-2.0
 *
 * Numbers shared with the host: frames, commands, codes, part image, settings.
 * Generated from protocol.toml by generate_protocol.py: do not edit.
 */
#ifndef LINK_PROTOCOL_H
#define LINK_PROTOCOL_H

#define PROTOCOL_VERSION                    3
#define FIRMWARE_VERSION_MAJOR              0
#define FIRMWARE_VERSION_MINOR              1
#define FIRMWARE_VERSION_PATCH              0
#define USB_VENDOR_ID                       0x1209
#define USB_PRODUCT_ID                      0x0001
#define USB_LOADER_PRODUCT_ID               0x0002

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

/* units of the part store; a part takes one to ten, its slot is the first */
#define PART_SLOTS                          10
/* bytes of one unit, 64 of them for its header when it is a part's first */
#define PART_UNIT                           256
/* no slot; in RUN: the selected part */
#define SLOT_NONE                           255
/* bytes of a part image */
#define PART_IMAGE_MAX                      2496
/* bytes of one UPLOAD_DATA or PART_READ piece */
#define UPLOAD_PIECE_MAX                    32
/* operations of one part */
#define OPERATIONS_MAX                      64
/* characters of a part name */
#define NAME_LENGTH                         16
/* characters of the serial number */
#define SERIAL_LENGTH                       8
/* steps, largest length or radius in a part image: the chip counts in 16
 * bits */
#define POSITION_MAX                        32000
/* 1/8 step/s, slowest feed: 4 step/s */
#define FEED_MIN                            32
/* feed units of one step/s */
#define FEED_UNIT                           8
/* percent, slowest feed override */
#define OVERRIDE_MIN                        10
/* percent, fastest feed override */
#define OVERRIDE_MAX                        200
/* characters of a tool name */
#define TOOL_NAME_LENGTH                    12
/* characters of a message of PAUSE */
#define MESSAGE_MAX                         32
/* most spring passes */
#define SPRING_MAX                          9
/* slope of one X step per Z step */
#define SLOPE_UNIT                          256
/* slope of an edge that can follow a square shoulder */
#define SLOPE_ANY                           65535L
/* bits of a contour's kind that tell what it is */
#define CONTOUR_KIND                        15
/* bit of a contour's kind: roughed in facing direction */
#define CONTOUR_FACING                      128
/* steps, largest retract: sums with it stay below 16 bits */
#define RETRACT_MAX                         8000
/* steps, most raw material in front of z = 0 */
#define STOCK_FRONT_MAX                     8000
/* steps, widest grooving tool */
#define WIDTH_MAX                           8000
/* steps, largest radius of an arc */
#define RADIUS_MAX                          32000
/* what LOADER must carry: no other request becomes one by a damaged byte */
#define LOADER_MAGIC                        21580
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
#define STATE_PAUSE                         5
#define STATE_MOVING                        6
#define STATE_TOUCHING                      7

/* Bits of the flags in STATUS. */
#define STATUS_FLAG_HOMED                   0x01
#define STATUS_FLAG_SWITCH_X                0x02
#define STATUS_FLAG_SWITCH_Z                0x04
#define STATUS_FLAG_ESTOP                   0x08
#define STATUS_FLAG_BUTTON_RUN              0x10
#define STATUS_FLAG_BUTTON_HOLD             0x20
#define STATUS_FLAG_BUTTON_STOP             0x40
#define STATUS_FLAG_MOTION                  0x80

/* Bits of the axes in HOME and STATUS. */
#define HOMED_AXIS_X                        0x01
#define HOMED_AXIS_Z                        0x02

/* Bits of the warnings in STATUS. */
#define WARNING_DEAD_X                      0x01
#define WARNING_DEAD_Z                      0x02

/* Bits of the flags in RUN. */
#define RUN_FLAG_STEP                       0x01
#define RUN_FLAG_RESUME                     0x02

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
#define ALARM_PATH                          11
#define ALARM_HOME_OPENED_LATE              12
#define ALARM_PHASE_DRIFT                   13
#define ALARM_SWITCH_WIRING                 14
#define ALARM_PROBE_UNEXPECTED              15

/* Bits of the inputs in STATUS. */
#define STATUS_INPUT_CONTACT                0x40
#define STATUS_INPUT_TOUCHED                0x80

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
#define ERROR_PROBE_CLOSED                  16
#define ERROR_NOT_FITTED                    17
#define ERROR_NOTHING_TO_RESUME             18
#define ERROR_WRONG_WAY                     19

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
#define STATUS_RESPONSE_SIZE                37
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
#define STATUS_RESPONSE_SPREAD_X_AT         32
#define STATUS_RESPONSE_SPREAD_Z_AT         33
#define STATUS_RESPONSE_HOMED_AXES_AT       34
#define STATUS_RESPONSE_WARNINGS_AT         35
#define STATUS_RESPONSE_INPUTS_AT           36
/* Find the limit switches, X first, and measure the dead steps. Answered at
 * once; STATUS tells the end. */
#define COMMAND_HOME                        0x03
#define HOME_REQUEST_SIZE                   1
#define HOME_RESPONSE_SIZE                  1
#define HOME_AXES_AT                        0
/* Cut a part. Answered when the chip has checked the part again; STATUS
 * tells the rest. */
#define COMMAND_RUN                         0x04
#define RUN_REQUEST_SIZE                    2
#define RUN_RESPONSE_SIZE                   1
#define RUN_SLOT_AT                         0
#define RUN_FLAGS_AT                        1
/* Stop the run so that it can go on. OK too when it is already held. A jog
 * or a way to a place brakes and is over. */
#define COMMAND_HOLD                        0x05
#define HOLD_REQUEST_SIZE                   0
#define HOLD_RESPONSE_SIZE                  1
/* Go on after HOLD. OK too when it already runs. */
#define COMMAND_RESUME                      0x06
#define RESUME_REQUEST_SIZE                 0
#define RESUME_RESPONSE_SIZE                1
/* End the run, the homing, a jog, a way or a touch. The position stays
 * trusted, except while homing (alarm STOPPED_HOMING). */
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
/* Move to a place, homed or not, one axis after the other as GOTO does. It
 * brakes to a stop as HOLD does, and is over, when no request of any kind
 * comes for `patience`. Not homed: x and z count from wherever the tool was
 * when the chip started, there are no soft limits, and it moves at
 * home_rate at most. OUT_OF_RANGE: homed, and not inside the travel.
 * WRONG_WAY: towards a limit switch that is pressed. */
#define COMMAND_JOG                         0x0B
#define JOG_REQUEST_SIZE                    12
#define JOG_RESPONSE_SIZE                   1
#define JOG_X_AT                            0
#define JOG_Z_AT                            4
#define JOG_RATE_AT                         8
#define JOG_PATIENCE_AT                     10
/* Move to a place: X first when it moves away from the spindle's axis, else
 * Z first. OUT_OF_RANGE: not inside the travel. */
#define COMMAND_GOTO                        0x0C
#define GOTO_REQUEST_SIZE                   10
#define GOTO_RESPONSE_SIZE                  1
#define GOTO_X_AT                           0
#define GOTO_Z_AT                           4
#define GOTO_RATE_AT                        8
/* Move as GOTO does, at latch_rate, until the contact sensor closes: then
 * the tool stands on the step that closed it, and STATUS tells where, with
 * TOUCHED. Like JOG it ends when no request comes for 500 ms. OUT_OF_RANGE:
 * not inside the travel. */
#define COMMAND_TOUCH                       0x0D
#define TOUCH_REQUEST_SIZE                  8
#define TOUCH_RESPONSE_SIZE                 1
#define TOUCH_X_AT                          0
#define TOUCH_Z_AT                          4
/* Restart into the boot loader, for another firmware. Answered; 50 ms later
 * the port vanishes, and that of the loader comes. Idle or under an alarm,
 * and at rest; else BUSY. Like the head of HELLO it stays as it is in every
 * version, so that any tornillo can update any firmware. OUT_OF_RANGE:
 * another magic. */
#define COMMAND_LOADER                      0x0E
#define LOADER_REQUEST_SIZE                 2
#define LOADER_RESPONSE_SIZE                1
#define LOADER_MAGIC_AT                     0
/* Which part was begun and not finished, and how far did it come? Known
 * without power too; forgotten when a part is begun anew. */
#define COMMAND_PROGRESS                    0x0F
#define PROGRESS_REQUEST_SIZE               0
#define PROGRESS_RESPONSE_SIZE              6
#define PROGRESS_RESPONSE_SLOT_AT           1
#define PROGRESS_RESPONSE_CRC_AT            2
#define PROGRESS_RESPONSE_OPERATION_AT      4
#define PROGRESS_RESPONSE_PASS_NUMBER_AT    5
/* Start to receive a part image; an upload under way is forgotten.
 * OUT_OF_RANGE: length is not 32 to 2496. */
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
 * HELLO shows it at once, USB from the next connection on. OUT_OF_RANGE: a
 * character outside ! to ~, or a comma; nothing is changed then. */
#define COMMAND_SERIAL_SET                  0x22
#define SERIAL_SET_REQUEST_SIZE             8
#define SERIAL_SET_RESPONSE_SIZE            1
#define SERIAL_SET_SERIAL_AT                0

/* Part image: header, then one record per operation. */
#define PART_IMAGE_FORMAT                   2
#define PART_IMAGE_HEADER_SIZE              32
#define PART_IMAGE_FORMAT_AT                0
#define PART_IMAGE_OPERATION_COUNT_AT       1
#define PART_IMAGE_FLAGS_AT                 2
#define PART_IMAGE_RESERVED_AT              3
#define PART_IMAGE_NAME_AT                  4
#define PART_IMAGE_STEP_X_NM_AT             20
#define PART_IMAGE_STEP_Z_NM_AT             22
#define PART_IMAGE_STOCK_RADIUS_AT          24
#define PART_IMAGE_STOCK_LENGTH_AT          26
#define PART_IMAGE_STOCK_FRONT_AT           28
#define PART_IMAGE_RETRACT_AT               30

/* Every operation record starts with these four bytes. */
#define OPERATION_TYPE_AT                   0
#define OPERATION_KIND_AT                   1
#define OPERATION_SIZE_AT                   2
#define OPERATION_HEAD_SIZE                 4

/* Another tool for what follows; kind is its number, from 0. Not the first:
 * the lathe parks and waits for RUN. */
#define OPERATION_TOOL                      1
#define OPERATION_TOOL_SIZE                 30
#define OPERATION_TOOL_NAME_AT              4
#define OPERATION_TOOL_NOSE_AT              16
#define OPERATION_TOOL_BELOW_AT             18
#define OPERATION_TOOL_WIDTH_AT             20
#define OPERATION_TOOL_BACK_AT              22
#define OPERATION_TOOL_FRONT_AT             24
#define OPERATION_TOOL_OFFSET_X_AT          26
#define OPERATION_TOOL_OFFSET_Z_AT          28

/* Cutting data for what follows; kind is the number of spring passes, 0 to
 * 9. */
#define OPERATION_CUT                       2
#define OPERATION_CUT_SIZE                  16
#define OPERATION_CUT_DEPTH_OF_CUT_AT       4
#define OPERATION_CUT_FINISH_ALLOWANCE_AT   6
#define OPERATION_CUT_FEED_AT               8
#define OPERATION_CUT_FINISH_FEED_AT        10
#define OPERATION_CUT_SPINDLE_AT            12
#define OPERATION_CUT_PECK_AT               14

/* Park and wait for RUN; kind 0 a message, 1 a drill to be used by hand. */
#define OPERATION_PAUSE                     3
#define OPERATION_PAUSE_MAX                 36
#define OPERATION_PAUSE_MESSAGE_AT          4

/* Rough and finish a contour. kind: 0 face, 1 cylinder, 2 cone, 3 arc, 4
 * profile; + 128 to rough in facing direction. segments: kind u8 (0 line, 1
 * convex arc, 2 concave arc), dx i16, dz i16, and for an arc the centre
 * from its start, cx i24, cz i24, in 1/256 step. */
#define OPERATION_CONTOUR                   4
#define OPERATION_CONTOUR_MAX               2408
#define OPERATION_CONTOUR_Z_AT              4
#define OPERATION_CONTOUR_X_AT              6
#define OPERATION_CONTOUR_SEGMENTS_AT       8

/* Cut straight in with a tool of a width. kind: 0 groove, 1 part off. z is
 * that of the tool's corner on the chuck's side. */
#define OPERATION_PLUNGE                    5
#define OPERATION_PLUNGE_SIZE               10
#define OPERATION_PLUNGE_Z_HIGH_AT          4
#define OPERATION_PLUNGE_Z_LOW_AT           6
#define OPERATION_PLUNGE_X_AT               8

/* Why a part is refused. The first broken rule is answered. First for the
 * whole part (operation 0): LENGTH, FORMAT, NAME, STEP_SIZE, STOCK,
 * OPERATION_COUNT, RETRACT, OUTSIDE_TRAVEL. Then for each operation in
 * turn: LENGTH, OPERATION_TYPE, ORDER, OPERATION_SIZE, FORMAT, TOOL,
 * OUTSIDE_TRAVEL, DEPTH_OF_CUT, ALLOWANCE, FEED, SPINDLE, OUTSIDE_STOCK,
 * DIRECTION, EMPTY_CUT, ARC, BACK_EDGE, FRONT_EDGE, BLOCKED. After the last
 * one (operation 0): OPERATION_COUNT. */
/* format is not 2, or a byte, flag or kind has a value that is not defined,
 * or width or below of a tool is more than 8000 */
#define REFUSAL_FORMAT                      1
/* shorter than its header, longer than 2496 bytes, fewer than 4 bytes left
 * for a record, or a record that is shorter than 4 bytes or reaches behind
 * the end */
#define REFUSAL_LENGTH                      2
/* empty, a character other than a-z 0-9 -, or characters after the first
 * zero */
#define REFUSAL_NAME                        3
/* step_x_nm or step_z_nm differs from the setting */
#define REFUSAL_STEP_SIZE                   4
/* stock_radius or stock_length is 0 or more than 32000, or stock_front is
 * more than 8000 */
#define REFUSAL_STOCK                       5
/* depth_of_cut is 0 or more than stock_radius */
#define REFUSAL_DEPTH_OF_CUT                6
/* feed or finish_feed is below 32 or above 8 * max_rate */
#define REFUSAL_FEED                        7
/* retract is 0 or more than 8000 */
#define REFUSAL_RETRACT                     8
/* operation_count is not 1 to 64, or not the number of PAUSE, CONTOUR and
 * PLUNGE records */
#define REFUSAL_OPERATION_COUNT             9
/* unknown type */
#define REFUSAL_OPERATION_TYPE              10
/* size is not that of its type; PAUSE: not 4 to 36; CONTOUR: no segment,
 * one of unknown kind, or bytes left over */
#define REFUSAL_OPERATION_SIZE              11
/* x below -below of the tool or above stock_radius, z of the start above
 * stock_front + retract, or a z below retract - stock_length; an arc's
 * highest and lowest point count too. PLUNGE: also z_high + width above
 * stock_front + retract */
#define REFUSAL_OUTSIDE_STOCK               12
/* whole part: zero_x + stock_radius + retract above 0, or zero_z +
 * stock_front + 2 * retract above 0, and the same with the offset of every
 * tool, or zero + offset is not -32000 to 0; operation: zero_x + offset + x
 * below -travel_x, or zero_z + offset + z below -travel_z */
#define REFUSAL_OUTSIDE_TRAVEL              13
/* a segment without length; a contour along Z that ends where it starts in
 * z, or nowhere comes below stock_radius; a facing one that ends at or in
 * front of stock_front; PLUNGE: x at or above stock_radius */
#define REFUSAL_EMPTY_CUT                   14
/* contour along Z, tool that cannot fall squarely: one step in front of its
 * start something larger than its first x is left */
#define REFUSAL_BLOCKED                     15
/* finish_allowance is more than depth_of_cut */
#define REFUSAL_ALLOWANCE                   16
/* the first record is not TOOL, or the second not CUT */
#define REFUSAL_ORDER                       17
/* CONTOUR with a tool of a width, or PLUNGE with one without */
#define REFUSAL_TOOL                        18
/* the circle through the start misses the end by more than a step
 * (motion/arc.h), its radius is below 2 or above 32000, or an end lies on
 * the wrong side of its centre (convex: x below it; concave: above it) */
#define REFUSAL_ARC                         19
/* a segment falls more steeply than back of the tool */
#define REFUSAL_BACK_EDGE                   20
/* a segment rises more steeply than front of the tool */
#define REFUSAL_FRONT_EDGE                  21
/* dz above 0, or x gets smaller somewhere in a contour roughed in facing
 * direction */
#define REFUSAL_DIRECTION                   22
/* spindle is neither 0 nor between the settings spindle_min and spindle_max */
#define REFUSAL_SPINDLE                     23

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
#define SETTING_SPINDLE_MIN                 26
#define SETTING_SPINDLE_MAX                 27
#define SETTING_PROBE_FITTED                28
#define SETTING_TOUCH_BACK_OFF              29
#define SETTING_HOME_PHASE_X                30
#define SETTING_HOME_PHASE_Z                31
#define SETTING_DEAD_JUMP                   32
#define SETTING_DRIFT_MAX                   33
#define SETTING_PANEL                       34
#define SETTING_PANEL_INCH                  35
#define SETTING_COUNT                       36

/* SETTINGS(X): X(id, name, default, min, max) for each, in order of id. */
#define SETTINGS(X)                                                          \
    X(0, STEP_X_NM, 7112, 100, 32000)                                        \
    X(1, STEP_Z_NM, 7112, 100, 32000)                                        \
    X(2, TRAVEL_X, 3575, 100, 32000)                                         \
    X(3, TRAVEL_Z, 16072, 100, 32000)                                        \
    X(4, ZERO_X, (-3575), (-32000), 0)                                       \
    X(5, ZERO_Z, (-8000), (-32000), 0)                                       \
    X(6, HOME_RATE, 800, 20, 4000)                                           \
    X(7, LATCH_RATE, 50, 20, 100)                                            \
    X(8, RAPID_RATE_X, 1000, 20, 32000)                                      \
    X(9, RAPID_RATE_Z, 1000, 20, 32000)                                      \
    X(10, SWITCH_TRAVEL_X, 0, 0, 200)                                        \
    X(11, SWITCH_TRAVEL_Z, 0, 0, 200)                                        \
    X(12, COIL_MODE, 0, 0, 3)                                                \
    X(13, ESTOP_FITTED, 1, 0, 1)                                             \
    X(14, INVERT_X, 0, 0, 1)                                                 \
    X(15, INVERT_Z, 0, 0, 1)                                                 \
    X(16, DEAD_MAX, 300, 0, 1000)                                            \
    X(17, DEAD_X, (-1), (-1), 1000)                                          \
    X(18, DEAD_Z, (-1), (-1), 1000)                                          \
    X(19, HOMING_REPEATS, 3, 1, 9)                                           \
    X(20, SPREAD_MAX, 2, 0, 50)                                              \
    X(21, ACCELERATION, 8000, 1100, 32000)                                   \
    X(22, START_RATE_X, 400, 20, 4000)                                       \
    X(23, START_RATE_Z, 400, 20, 4000)                                       \
    X(24, IDLE_MS, (-1), (-1), 32000)                                        \
    X(25, PULSE_US, 5, 5, 60)                                                \
    X(26, SPINDLE_MIN, 100, 0, 32000)                                        \
    X(27, SPINDLE_MAX, 3800, 1, 32000)                                       \
    X(28, PROBE_FITTED, 0, 0, 1)                                             \
    X(29, TOUCH_BACK_OFF, 50, 1, 1000)                                       \
    X(30, HOME_PHASE_X, (-1), (-1), 7)                                       \
    X(31, HOME_PHASE_Z, (-1), (-1), 7)                                       \
    X(32, DEAD_JUMP, 5, 0, 1000)                                             \
    X(33, DRIFT_MAX, 1, 0, 50)                                               \
    X(34, PANEL, 0, 0, 2)                                                    \
    X(35, PANEL_INCH, 0, 0, 1)

#endif
