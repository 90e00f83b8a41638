"""Histories of runs on springs: one row for every sample, both sides of every event, and steps where they are wanted."""

from rockbatch.core.kernel import kernel

HISTORY_COLUMNS = 13  # t, the six of State, the five of Contact, kind of row


@kernel
def write(history, row, t, y, contact, kind):
    """Row of a history, where there is room for it; the next row. Where there is no history, rows are not counted."""
    if history.shape[0] == 0:
        return row
    if row < history.shape[0]:
        line = history[row]
        line[0] = max(t, history[row - 1, 0]) if row > 0 else t  # sums of pieces are rounded, time does not go back
        line[1] = y.v
        line[2] = y.theta
        line[3] = y.v_rate
        line[4] = y.omega
        line[5] = y.z_left
        line[6] = y.z_right
        line[7] = contact.left
        line[8] = contact.right
        line[9] = contact.left_yields
        line[10] = contact.right_yields
        line[11] = contact.held
        line[12] = kind
    return row + 1
