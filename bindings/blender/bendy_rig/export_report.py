"""The report of an export: what was written, what the file cannot express, and errors."""


class ExportReport:
    def __init__(self):
        self.is_finished = False    # the exporter has reached the end of a scene
        self.joints = []            # names of the joints with limits
        self.chains = []            # names of the chains
        self.notes = []             # texts: differences between the file and Blender
        self.errors = []

    def add_notes(self, owner, notes):
        self.notes += [f'{owner}: {text}' for _, text in notes]

    def summary(self):
        text = f'{count(self.joints, "joint")} with limits, {count(self.chains, "IK chain")}'
        return text + (f'; {count(self.notes, "thing")} not said as Blender has it' if self.notes else '')

    def lines(self):
        return [f'Bendy rig: {self.summary()}', *(f'  {note}' for note in self.notes), *(f'  error: {e}' for e in self.errors)]


def count(things, name):
    return f'{len(things)} {name}' + ('' if len(things) == 1 else 's')
