"""The structs of `carom.layouts` as Warp structs, for device code to import."""

from typing import TYPE_CHECKING

from carom.kernels.warp_types import warp_type
from carom.layouts import chain, contacts, images, mechanism, model, motor_commands, parallel, queries, soft

if TYPE_CHECKING:
    from carom.layouts.chain import Chain, ChainSizes, Search
    from carom.layouts.contacts import (
        Candidate,
        CandidateRows,
        Contacts,
        ContactTerms,
        ManifoldBlock,
        ManifoldBlocks,
        ManifoldSide,
        ManifoldSides,
        PairRows,
        Pairs,
        Shapes,
        TermsRows,
        UserConstraints,
    )
    from carom.layouts.images import Lighting, Picture, Scene, View
    from carom.layouts.mechanism import Control, Ends, MechanismSizes, MechanismTable
    from carom.layouts.model import Dofs, Model, Scratch, Settings, State, Trees
    from carom.layouts.motor_commands import MotorCommands
    from carom.layouts.parallel import IslandProgress, IslandWork, PairWork, RunWork
    from carom.layouts.queries import ContactReport, Places, Rays, Searches, Touching
    from carom.layouts.soft import SoftModel, SoftWork
else:
    IslandProgress = warp_type(parallel.IslandProgress)
    IslandWork = warp_type(parallel.IslandWork)
    PairWork = warp_type(parallel.PairWork)
    RunWork = warp_type(parallel.RunWork)
    ChainSizes = warp_type(chain.ChainSizes)
    Chain = warp_type(chain.Chain)
    Search = warp_type(chain.Search)
    Shapes = warp_type(contacts.Shapes)
    Candidate = warp_type(contacts.Candidate)
    CandidateRows = warp_type(contacts.CandidateRows)
    Pairs = warp_type(contacts.Pairs)
    Contacts = warp_type(contacts.Contacts)
    UserConstraints = warp_type(contacts.UserConstraints)
    ManifoldBlock = warp_type(contacts.ManifoldBlock)
    ManifoldSide = warp_type(contacts.ManifoldSide)
    ContactTerms = warp_type(contacts.ContactTerms)
    ManifoldBlocks = warp_type(contacts.ManifoldBlocks)
    ManifoldSides = warp_type(contacts.ManifoldSides)
    TermsRows = warp_type(contacts.TermsRows)
    PairRows = warp_type(contacts.PairRows)
    Scene = warp_type(images.Scene)
    View = warp_type(images.View)
    Lighting = warp_type(images.Lighting)
    Picture = warp_type(images.Picture)
    Settings = warp_type(model.Settings)
    Trees = warp_type(model.Trees)
    Dofs = warp_type(model.Dofs)
    Model = warp_type(model.Model)
    State = warp_type(model.State)
    Scratch = warp_type(model.Scratch)
    MotorCommands = warp_type(motor_commands.MotorCommands)
    MechanismSizes = warp_type(mechanism.MechanismSizes)
    Ends = warp_type(mechanism.Ends)
    MechanismTable = warp_type(mechanism.MechanismTable)
    Control = warp_type(mechanism.Control)
    Places = warp_type(queries.Places)
    ContactReport = warp_type(queries.ContactReport)
    Searches = warp_type(queries.Searches)
    Rays = warp_type(queries.Rays)
    Touching = warp_type(queries.Touching)
    SoftModel = warp_type(soft.SoftModel)
    SoftWork = warp_type(soft.SoftWork)
