/* Commands of the link.
   SPDX-License-Identifier: Apache-2.0 */

#include "link/commands.h"
#include "lathe/homing.h"     /* spread, warnings */
#include "lathe/machine.h"    /* state, actions */
#include "lathe/manual.h"     /* jog, goto, touch */
#include "lathe/part.h"       /* operations */
#include "lathe/part_check.h" /* upload, max rate */
#include "lathe/passes.h"     /* progress of the run */
#include "lathe/progress.h"   /* of the part not finished */
#include "link/frame.h"       /* request, response */
#include "link/lengths.h"     /* of requests */
#include "link/protocol.h"    /* numbers */
#include "motion/path.h"      /* dead steps */
#include "motion/ramp.h"      /* hold, override */
#include "motion/stream.h"    /* positions */
#include "panel/inputs.h"     /* switches, buttons */
#include "store/eeprom.h"     /* serial number */
#include "store/flash.h"      /* reading */
#include "store/parts.h"      /* parts */
#include "store/settings.h"   /* settings */
#include "reset.h"            /* cause */
#include "tick.h"             /* uptime */

uint8_t commands_leaving;

/* Of the main loop, 4 ms each: 50 ms for the answer to reach the host. */
#define LEAVING_TURNS 13

static void put_u16(uint8_t at, uint16_t value)
{
    path_keep_up(); /* STATUS takes 2 ms, the step queue may last 3 */
    frame_response[at] = (uint8_t)value;
    frame_response[at + 1] = (uint8_t)(value >> 8);
}

/* The wire has 32 bits where the chip has 16. */
static void put_i32(uint8_t at, int16_t value)
{
    put_u16(at, (uint16_t)value);
    put_u16(at + 2, value < 0 ? 0xFFFF : 0);
}

static uint16_t get_u16(uint8_t at)
{
    return frame_payload[at] | (uint16_t)(frame_payload[at + 1] << 8);
}

/* A 32-bit value that does not fit comes as the largest or smallest number,
   which is out of every range. */
static int16_t get_i16(uint8_t at)
{
    int16_t low = (int16_t)get_u16(at);
    int16_t high = (int16_t)get_u16(at + 2);

    if (high != (low < 0 ? -1 : 0)) {
        return high < 0 ? -32767 - 1 : 32767;
    }
    return low;
}

static void put_uptime(void)
{
    uint16_t high;

    do {
        high = tick_high;
        put_u16(STATUS_RESPONSE_UPTIME_MS_AT, tick_now());
        put_u16(STATUS_RESPONSE_UPTIME_MS_AT + 2, high);
    } while (high != tick_high);
}

static uint8_t hello(void)
{
    uint8_t i;

    frame_response[HELLO_RESPONSE_PROTOCOL_AT] = PROTOCOL_VERSION;
    frame_response[HELLO_RESPONSE_FIRMWARE_MAJOR_AT] = FIRMWARE_VERSION_MAJOR;
    frame_response[HELLO_RESPONSE_FIRMWARE_MINOR_AT] = FIRMWARE_VERSION_MINOR;
    frame_response[HELLO_RESPONSE_FIRMWARE_PATCH_AT] = FIRMWARE_VERSION_PATCH;
    frame_response[HELLO_RESPONSE_SLOTS_AT] = PART_SLOTS;
    put_u16(HELLO_RESPONSE_IMAGE_MAX_AT, PART_IMAGE_MAX);
    /* Six settings in the order of the response: step sizes, travels,
       zeros. */
    for (i = 0; i < 6; i++) {
        put_i32(HELLO_RESPONSE_STEP_X_NM_AT + 4 * i, settings[i]);
    }
    for (i = 0; i < SERIAL_LENGTH; i++) {
        frame_response[HELLO_RESPONSE_SERIAL_AT + i] = USB_SERIAL_CHARACTER(i);
    }
    put_u16(HELLO_RESPONSE_MAX_RATE_AT, part_check_max_rate());
    return HELLO_RESPONSE_SIZE;
}

static uint8_t status_flags(void)
{
    uint8_t inputs = inputs_state;
    uint8_t flags = 0;

    if (machine_homed) {
        flags |= STATUS_FLAG_HOMED;
    }
    if (inputs & INPUT_LIMIT_X) {
        flags |= STATUS_FLAG_SWITCH_X;
    }
    if (inputs & INPUT_LIMIT_Z) {
        flags |= STATUS_FLAG_SWITCH_Z;
    }
    if (inputs & INPUT_ESTOP) {
        flags |= STATUS_FLAG_ESTOP;
    }
    if (inputs & INPUT_RUN) {
        flags |= STATUS_FLAG_BUTTON_RUN;
    }
    if (inputs & INPUT_HOLD) {
        flags |= STATUS_FLAG_BUTTON_HOLD;
    }
    if (inputs & INPUT_STOP) {
        flags |= STATUS_FLAG_BUTTON_STOP;
    }
    if ((stream_flags & STREAM_ACTIVE) && !ramp_held()) {
        flags |= STATUS_FLAG_MOTION;
    }
    return flags;
}

static uint8_t status(void)
{
    uint8_t running = machine_running();

    frame_response[STATUS_RESPONSE_STATE_AT] = machine_state;
    frame_response[STATUS_RESPONSE_ALARM_AT] = machine_alarm;
    frame_response[STATUS_RESPONSE_ALARM_DETAIL_AT] = machine_alarm_detail;
    frame_response[STATUS_RESPONSE_FLAGS_AT] = status_flags();
    put_i32(STATUS_RESPONSE_X_AT, stream_position(AXIS_X));
    put_i32(STATUS_RESPONSE_Z_AT, stream_position(AXIS_Z));
    put_u16(STATUS_RESPONSE_DEAD_X_AT, motion_dead_x);
    put_u16(STATUS_RESPONSE_DEAD_Z_AT, motion_dead_z);
    frame_response[STATUS_RESPONSE_SLOT_AT] =
        running ? machine_slot : parts_selected();
    frame_response[STATUS_RESPONSE_OPERATION_AT] =
        running ? passes_operation() : 0;
    frame_response[STATUS_RESPONSE_OPERATIONS_AT] =
        running ? part_operations : 0;
    frame_response[STATUS_RESPONSE_PASS_NUMBER_AT] =
        running ? passes_pass() : 0;
    frame_response[STATUS_RESPONSE_PASSES_AT] = running ? passes_passes() : 0;
    put_u16(STATUS_RESPONSE_PERMILLE_AT, machine_permille());
    frame_response[STATUS_RESPONSE_RESET_CAUSE_AT] = reset_cause();
    put_u16(STATUS_RESPONSE_BAD_FRAMES_AT, frame_bad_frames);
    put_uptime();
    frame_response[STATUS_RESPONSE_STREAM_LOW_AT] = stream_low;
    frame_response[STATUS_RESPONSE_SPREAD_X_AT] = homing_spread[AXIS_X];
    frame_response[STATUS_RESPONSE_SPREAD_Z_AT] = homing_spread[AXIS_Z];
    frame_response[STATUS_RESPONSE_HOMED_AXES_AT] = machine_homed_axes;
    frame_response[STATUS_RESPONSE_WARNINGS_AT] = homing_warnings;
    frame_response[STATUS_RESPONSE_INPUTS_AT] = inputs_state | manual_contact;
    return STATUS_RESPONSE_SIZE;
}

static uint8_t progress(void)
{
    frame_response[PROGRESS_RESPONSE_SLOT_AT] = progress_slot();
    frame_response[PROGRESS_RESPONSE_CRC_AT] = progress_record[PROGRESS_CRC_AT];
    frame_response[PROGRESS_RESPONSE_CRC_AT + 1] =
        progress_record[PROGRESS_CRC_AT + 1];
    frame_response[PROGRESS_RESPONSE_OPERATION_AT] =
        progress_record[PROGRESS_OPERATION_AT];
    frame_response[PROGRESS_RESPONSE_PASS_NUMBER_AT] =
        progress_record[PROGRESS_PASS_AT];
    return PROGRESS_RESPONSE_SIZE;
}

static uint8_t upload_commit(void)
{
    uint8_t error = parts_upload_finish();
    uint8_t reason;

    if (error == ERROR_OK) {
        reason = part_check(parts_upload_slot, parts_upload_length);
        if (reason != 0) {
            frame_response[0] = ERROR_INVALID_PART;
            frame_response[1] = reason;
            frame_response[2] = part_check_operation;
            return 3;
        }
        error = parts_upload_accept();
    }
    frame_response[0] = error;
    if (error != ERROR_OK) {
        return 1;
    }
    frame_response[UPLOAD_COMMIT_RESPONSE_SLOT_AT] = parts_upload_slot;
    put_u16(UPLOAD_COMMIT_RESPONSE_CRC_AT, parts_crc);
    return UPLOAD_COMMIT_RESPONSE_SIZE;
}

static uint8_t part_info(void)
{
    uint8_t slot = frame_payload[PART_INFO_SLOT_AT];
    uint8_t i;

    if (slot >= PART_SLOTS) {
        frame_response[0] = ERROR_OUT_OF_RANGE;
        return 1;
    }
    for (i = 1; i < PART_INFO_RESPONSE_SIZE; i++) {
        frame_response[i] = 0;
    }
    frame_response[PART_INFO_RESPONSE_SELECTED_AT] = parts_selected() == slot;
    if (parts_present(slot)) {
        frame_response[PART_INFO_RESPONSE_PRESENT_AT] = 1;
        put_u16(PART_INFO_RESPONSE_GENERATION_AT, parts_generation);
        put_u16(PART_INFO_RESPONSE_LENGTH_AT, parts_length);
        put_u16(PART_INFO_RESPONSE_CRC_AT, parts_crc);
        parts_open(slot);
        parts_seek(PART_IMAGE_OPERATION_COUNT_AT);
        frame_response[PART_INFO_RESPONSE_OPERATIONS_AT] = flash_read();
        parts_read_name(slot);
        for (i = 0; i < NAME_LENGTH; i++) {
            frame_response[PART_INFO_RESPONSE_NAME_AT + i] = parts_name[i];
        }
    }
    return PART_INFO_RESPONSE_SIZE;
}

static uint8_t part_read(void)
{
    uint8_t slot = frame_payload[PART_READ_SLOT_AT];
    uint16_t offset = get_u16(PART_READ_OFFSET_AT);
    uint16_t length;
    uint8_t i;

    if (!parts_present(slot)) {
        frame_response[0] = ERROR_NO_PART;
        return 1;
    }
    length = parts_length;
    if (offset >= length || (offset & (UPLOAD_PIECE_MAX - 1))) {
        frame_response[0] = ERROR_BAD_OFFSET;
        return 1;
    }
    length -= offset;
    parts_open(slot);
    parts_seek(offset);
    for (i = 0; i < UPLOAD_PIECE_MAX && i < length; i++) {
        frame_response[PART_READ_RESPONSE_DATA_AT + i] = flash_read();
    }
    return PART_READ_RESPONSE_DATA_AT + i;
}

static uint8_t setting_get(void)
{
    uint8_t id = frame_payload[SETTING_GET_ID_AT];

    if (id >= SETTING_COUNT) {
        frame_response[0] = ERROR_OUT_OF_RANGE;
        return 1;
    }
    put_i32(SETTING_GET_RESPONSE_VALUE_AT, settings[id]);
    put_i32(SETTING_GET_RESPONSE_MINIMUM_AT, settings_minimum(id));
    put_i32(SETTING_GET_RESPONSE_MAXIMUM_AT, settings_maximum(id));
    return SETTING_GET_RESPONSE_SIZE;
}

/* The first round judges the characters, the second stores them: nothing
   changes unless all are good. */
static uint8_t serial_set(void)
{
    uint8_t i;
    uint8_t character;

    for (i = 0; i < 2 * SERIAL_LENGTH; i++) {
        character = frame_payload[SERIAL_SET_SERIAL_AT + i % SERIAL_LENGTH];
        if (character < '!' || character > '~' || character == ',') {
            return ERROR_OUT_OF_RANGE;
        }
        if (i >= SERIAL_LENGTH) {
            eeprom_write(EEPROM_SERIAL - SERIAL_LENGTH + i, character);
        }
    }
    usb_read_serial_number();
    return ERROR_OK;
}

/* Commands that write flash or EEPROM; only while nothing moves. */
static uint8_t change_store(void)
{
    if (!machine_quiet()) {
        return ERROR_BUSY;
    }
    switch (frame_code) {
    case COMMAND_UPLOAD_BEGIN:
        return parts_upload_begin(get_u16(UPLOAD_BEGIN_LENGTH_AT),
                                  get_u16(UPLOAD_BEGIN_CRC_AT));
    case COMMAND_UPLOAD_DATA:
        return parts_upload_data(get_u16(UPLOAD_DATA_OFFSET_AT),
                                 &frame_payload[UPLOAD_DATA_DATA_AT],
                                 frame_length - UPLOAD_DATA_DATA_AT);
    case COMMAND_PART_SELECT:
        return parts_select(frame_payload[PART_SELECT_SLOT_AT]);
    case COMMAND_PART_DELETE:
        return parts_delete(frame_payload[PART_DELETE_SLOT_AT]);
    case COMMAND_SERIAL_SET:
        return serial_set();
    case COMMAND_LOADER:
        if (get_u16(LOADER_MAGIC_AT) != LOADER_MAGIC) {
            return ERROR_OUT_OF_RANGE;
        }
        commands_leaving = LEAVING_TURNS;
        return ERROR_OK;
    default: /* COMMAND_SETTING_SET */
        return machine_set(frame_payload[SETTING_SET_ID_AT],
                           get_i16(SETTING_SET_VALUE_AT));
    }
}

uint8_t commands_execute(void)
{
    uint8_t error;

    manual_heard();
    if (!lengths_fit()) {
        frame_response[0] = ERROR_BAD_LENGTH;
        return 1;
    }
    frame_response[0] = ERROR_OK;
    switch (frame_code) {
    case COMMAND_HELLO:
        return hello();
    case COMMAND_STATUS:
        return status();
    case COMMAND_UPLOAD_COMMIT:
        if (machine_quiet()) {
            return upload_commit();
        }
        error = ERROR_BUSY;
        break;
    case COMMAND_PART_INFO:
        return part_info();
    case COMMAND_PART_READ:
        return part_read();
    case COMMAND_SETTING_GET:
        return setting_get();
    case COMMAND_PROGRESS:
        return progress();
    case COMMAND_JOG:
    case COMMAND_GOTO:
    case COMMAND_TOUCH:
        error = manual_begin(frame_code, get_i16(JOG_X_AT), get_i16(JOG_Z_AT),
                             get_u16(JOG_RATE_AT), get_u16(JOG_PATIENCE_AT));
        break;
    case COMMAND_HOME:
        error = machine_home(frame_payload[HOME_AXES_AT]);
        break;
    case COMMAND_RUN:
        error = machine_run(frame_payload[RUN_SLOT_AT],
                            frame_payload[RUN_FLAGS_AT]);
        break;
    case COMMAND_HOLD:
        error = machine_hold();
        break;
    case COMMAND_RESUME:
        error = machine_resume();
        break;
    case COMMAND_STOP:
        error = machine_stop();
        break;
    case COMMAND_RESET:
        error = machine_reset();
        break;
    case COMMAND_ZERO:
        error =
            machine_zero(frame_payload[ZERO_AXIS_AT], get_i16(ZERO_VALUE_AT));
        break;
    case COMMAND_OVERRIDE:
        error = machine_override(frame_payload[OVERRIDE_PERCENT_AT]);
        break;
    case COMMAND_UPLOAD_BEGIN:
    case COMMAND_UPLOAD_DATA:
    case COMMAND_PART_SELECT:
    case COMMAND_PART_DELETE:
    case COMMAND_SETTING_SET:
    case COMMAND_SERIAL_SET:
    case COMMAND_LOADER:
        error = change_store();
        break;
    default:
        error = ERROR_UNKNOWN_COMMAND;
        break;
    }
    frame_response[0] = error;
    return 1;
}
