"""The environments as other libraries want them, one file for each library; nothing of them is imported before it is asked for.

Libraries that take Gymnasium's own environments and vector environments (CleanRL, TorchRL, RLlib) need no adapter and have none here.
"""
